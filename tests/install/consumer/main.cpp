#include <cstdio>

#include "lamella/core/build_info.h"
#include "lamella/core/parallel.h"
#include "lamella/core/random.h"
#include "lamella/sim/registry.h"

// Calls into layers with and without a library behind them, and checks that headers and library are of one version.
int main(int argc, char** argv) {
    const lamella::BuildInfo info = lamella::build_info();
    if (argc != 2 || info.version != argv[1]) {
        std::fprintf(stderr, "linked against version %s\n", info.version.c_str());
        return 1;
    }
    constexpr std::size_t kCount = 100'000;
    const double mean = lamella::parallel_sum(kCount, [](std::size_t i) {
        return uniform01(lamella::random_bits(1, lamella::RandomStream::kBubblePosition, 0, i));
    }) / kCount;
    const lamella::sim::SolverRegistry registry;
    std::printf("lamella %s (%s), mean %.4f\n", info.version.c_str(), info.commit.c_str(), mean);
    return mean > 0.49 && mean < 0.51 && registry.entries().empty() ? 0 : 1;
}
