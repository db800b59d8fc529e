// Sums of the regularized law of Biot and Savart: all pairs beside the roof of the same kernel, and the tree.

#include "lamella/core/parallel.h"
#include "lamella/spatial/detail/vortex_pair.h"
#include "lamella/spatial/detail/wide.h"
#include "lamella/spatial/vortex_sum.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <numbers>

namespace {

using namespace lamella;
using namespace lamella::spatial;

/// A sphere with points on a Fibonacci spiral and a smooth tangential sheet strength.
struct Sphere {
    std::vector<Vec3> centers, strengths;
    double spacing;

    explicit Sphere(std::size_t count) : spacing(std::sqrt(4.0 * std::numbers::pi / static_cast<double>(count))) {
        for (std::size_t i = 0; i < count; ++i) {
            const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
            const double angle = static_cast<double>(i) * std::numbers::pi * (3.0 - std::sqrt(5.0));
            const double rho = std::sqrt(1.0 - z * z);
            centers.push_back({{rho * std::cos(angle), rho * std::sin(angle), z}});
            strengths.push_back(spacing * spacing * cross(centers.back(), Vec3{{z, 0.3, 1.0}}));
        }
    }
};

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Pairs per second of the kernel alone: one vector of targets, 256 sources in the first-level cache, nothing else.
template <VortexKernel kernel, bool with_potential, class Wide>
double roof() {
    using T = typename Wide::Scalar;
    alignas(64) T sources[6][256];
    alignas(64) T lanes[64] = {};
    for (std::size_t i = 0; i < 256; ++i)
        for (std::size_t k = 0; k < 6; ++k) sources[k][i] = static_cast<T>(std::sin(static_cast<double>(7 * i + k)));
    const Wide zero = Wide::all(0), x = Wide::load(lanes);
    double best = 0.0;
    for (int trial = 0; trial < 5; ++trial) {
        spatial::detail::PairSums<Wide> sums{{zero, zero, zero}, {zero, zero, zero}};
        constexpr int kRounds = 20'000;
        const double start = cpu_seconds();
        for (int round = 0; round < kRounds; ++round) {
            benchmark::ClobberMemory();  // the sources may have changed: no round is like another
            for (std::size_t j = 0; j < 256; ++j)
                spatial::detail::add_pair<kernel, with_potential, Wide>(
                    sums, x, x, x, Wide::all(sources[0][j]), Wide::all(sources[1][j]), Wide::all(sources[2][j]),
                    Wide::all(sources[3][j]), Wide::all(sources[4][j]), Wide::all(sources[5][j]));
        }
        const double seconds = cpu_seconds() - start;
        for (std::size_t k = 0; k < 3; ++k) {
            benchmark::DoNotOptimize(sums.u[k].v);
            if (with_potential) benchmark::DoNotOptimize(sums.a[k].v);
        }
        best = std::max(best, 256.0 * kRounds * static_cast<double>(Wide::kSize) / seconds);
    }
    return best;
}

/// Argument: threads. Counts pairs, per second of CPU time on one thread and of the clock on more.
template <VortexKernel kernel, bool with_potential, class Wide>
void direct(benchmark::State& state) {
    const Sphere s(8192);
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    VortexSumOptions options{.kernel = kernel, .delta = 1.5 * s.spacing, .method = VortexSumOptions::Method::kDirect};
    options.precision = sizeof(typename Wide::Scalar) == 4 ? VortexSumOptions::Precision::kSingle
                                                           : VortexSumOptions::Precision::kDouble;
    double fastest = 1e300;
    for (auto _ : state) {
        const double start = cpu_seconds();
        benchmark::DoNotOptimize(vortex_sum(s.centers, s.centers, s.strengths, options, with_potential));
        fastest = std::min(fastest, cpu_seconds() - start);
    }
    const double pairs = 8192.0 * 8192.0;
    state.counters["pairs"] = benchmark::Counter(pairs, benchmark::Counter::kIsIterationInvariantRate);
    if (state.range(0) > 1) return;
    const double top = roof<kernel, with_potential, Wide>();
    state.counters["roof"] = top;
    state.counters["of_roof"] = pairs / fastest / top;
}

/// Arguments: elements, digits of the tolerance, single precision or not.
void tree(benchmark::State& state) {
    const Sphere s(static_cast<std::size_t>(state.range(0)));
    const ThreadLimit limit(1);
    VortexSumOptions options{.delta = 1.5 * s.spacing,
                             .tolerance = std::pow(10.0, -static_cast<double>(state.range(1)))};
    if (state.range(2) != 0) options.precision = VortexSumOptions::Precision::kSingle;
    for (auto _ : state) benchmark::DoNotOptimize(vortex_sum(s.centers, s.centers, s.strengths, options, true));
}

using lamella::spatial::detail::WideDouble;
using lamella::spatial::detail::WideFloat;
constexpr auto kPlummer = VortexKernel::kPlummer;
constexpr auto kK2 = VortexKernel::kK2;
constexpr auto kK3 = VortexKernel::kK3;

BENCHMARK(direct<kPlummer, false, WideDouble>)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(direct<kK2, false, WideDouble>)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(direct<kK3, false, WideDouble>)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(direct<kK3, true, WideDouble>)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(direct<kPlummer, false, WideFloat>)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(direct<kK3, false, WideFloat>)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(direct<kK3, true, WideFloat>)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(tree)
    ->ArgsProduct({{20'000, 400'000}, {4, 5}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
