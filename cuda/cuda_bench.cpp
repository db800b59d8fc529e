// cuda_bench: what the GPU reaches. Needs nothing but the CUDA toolkit.
//
// usage: cuda_bench [SECONDS]         tables, SECONDS (default 3) for each row
//        cuda_bench phase TAU [SEED]  a foam as bubble/phase-separation, a million bubbles, up to scaled time TAU

#include "lamella/core/cuda.h"
#include "lamella/solvers/bubble/detail/device_runner.h"
#include "lamella/spatial/detail/vortex_gather.h"

#include "foam_in_place.h"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

using namespace lamella;
using namespace lamella::bubble;
namespace device = lamella::bubble::detail;
using Seconds = std::chrono::duration<double>;

double now() { return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Bytes that have to move for each bubble: by each evaluation (stage update and gather) and by the rest of a step
/// (error and acceptance). Neighbors are taken to come from the cache.
struct Traffic {
    double evaluation, step;
};
template <int D>
Traffic traffic(double list_length) {
    constexpr double kWord = 8.0;
    constexpr double kBall = 32.0;
    const double update = kWord * (5 * D + 6) + kBall      // x, d_(j-1), d_(j-2), f_0, f_(j-1) and the same of q
                          + kWord * (D + 1) + kBall;       // d_j, stage
    const double gather = kBall + 4.0 + 4.0 * list_length  // stage, list
                          + kWord * (D + 2);               // f_j
    const double error = kWord * (3 * D + 4) + kBall;
    const double accept = kWord * (4 * D + 5) + kBall + 4.0 * D + kWord * (2 * D + 3);
    return {update + gather, error + accept};
}

Options foam_options(int dimension, int count) {
    Options o;
    o.dimension = dimension;
    o.count = count;
    o.end_count = 1;
    o.gas_fraction = dimension == 2 ? 0.95 : 0.75;
    return o;
}

template <int D>
void upload(device::DeviceRunner<D>& runner, const Options& o, std::uint64_t seed = 0) {
    const Foam<D> foam = FoamInPlace::make<D>(o, seed);
    runner.upload(foam, FoamInPlace::model<D>(o, foam), {},
                  {.next_step = 1e-3, .stiffness = 0.0, .rates_current = false});
}

template <int D>
void bubble_row(int count, double seconds, double copy_rate) {
    const Options o = foam_options(D, count);
    const auto runner = device::make_cuda_runner<D>(o);
    upload(*runner, o);
    runner->advance(1e9, 200);  // the grid relaxes, the steps grow
    const Clock before = runner->control().clock;
    const double begin = now();
    double bubble_steps = 0.0;
    while (now() - begin < seconds) {
        const Clock last = runner->control().clock;
        runner->advance(1e9, 32);
        bubble_steps += static_cast<double>(runner->control().clock.steps - last.steps) *
                        static_cast<double>(runner->control().live);
        runner->take_vanished();
    }
    const double took = now() - begin;
    const Clock after = runner->control().clock;
    const double stages =
        static_cast<double>(after.evaluations - before.evaluations) / static_cast<double>(after.steps - before.steps);
    const Traffic bytes = traffic<D>(D == 2 ? 5.6 : 11.0);
    const double rate = bubble_steps * (bytes.step + stages * bytes.evaluation) / took;
    std::printf("| %dD | %8d | %.3g | %.3g | %.2f | %.3g | %.0f %% |\n", D, count, bubble_steps / took,
                bubble_steps * stages / took, stages, rate, 100.0 * rate / copy_rate);
    std::fflush(stdout);
}

void vortex_row(std::size_t count, bool single, double seconds) {
    using namespace lamella::spatial;
    std::vector<Vec3> targets(count);
    std::vector<spatial::detail::GatherSource> sources(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            targets[i][k] = sources[i].x[k] = 100.0 * FoamInPlace::uniform(6 * i + k);
            sources[i].g[k] = FoamInPlace::uniform(6 * i + 3 + k) - 0.5;
        }
    const spatial::detail::PairLaw law{VortexKernel::kK3, true, single};
    const double begin = now();
    double pairs = -static_cast<double>(count) * static_cast<double>(count);  // the first call warms up
    double counted_from = begin;
    do {
        static_cast<void>(spatial::detail::gather_on_gpu(targets, sources, law));
        if (pairs < 0.0) counted_from = now();
        pairs += static_cast<double>(count) * static_cast<double>(count);
    } while (now() - begin < seconds || pairs == 0.0);
    std::printf("| %s | %8zu | %.3g |\n", single ? "float" : "double", count, pairs / (now() - counted_from));
    std::fflush(stdout);
}

/// Standard deviation of the gas fraction over 10 x 10 equal parts, and the share of 100 x 100 cells without a center.
void print_spread(const Foam<2>& foam) {
    std::vector<double> gas(100, 0.0);
    std::vector<int> occupied(10000, 0);
    double radii = 0.0;
    for (std::size_t i = 0; i < foam.slots; ++i) {
        if (!foam.alive(i)) continue;
        radii += Shape<2>::radius(foam.size[i]);
        const auto part = [&](std::size_t k, double n) {
            return static_cast<std::size_t>(std::clamp(foam.position[k][i] / foam.box.lengths[k] * n, 0.0, n - 1.0));
        };
        gas[part(1, 10.0) * 10 + part(0, 10.0)] += Shape<2>::kVolume * foam.size[i] / (foam.box.volume() / 100.0);
        occupied[part(1, 100.0) * 100 + part(0, 100.0)] = 1;
    }
    double mean = 0.0;
    double squares = 0.0;
    for (const double g : gas) mean += g / 100.0;
    for (const double g : gas) squares += (g - mean) * (g - mean) / 100.0;
    const auto empty = std::count(occupied.begin(), occupied.end(), 0);
    std::printf(" %8zu | %.4f | %.4f | %.2f %% |", foam.live, radii / static_cast<double>(foam.live),
                std::sqrt(squares), static_cast<double>(empty) / 100.0);
}

void phase_separation(double end, std::uint64_t seed) {
    Options o = foam_options(2, 1'000'000);
    o.end_count = 2000;
    o.gas_fraction = 0.851;
    const auto runner = device::make_cuda_runner<2>(o);
    upload(*runner, o, seed);
    std::printf(
        "\nphase separation, a million bubbles at gas fraction 0.851, seed %llu, from a jittered grid that was not "
        "relaxed\n\n",
        static_cast<unsigned long long>(seed));
    std::printf(
        "| tau | bubbles | <R> | spread of the gas fraction, 10 x 10 | cells of 100 x 100 without a center | steps | "
        "computing [s] |\n|---|---|---|---|---|---|---|\n");
    double computing = 0.0;
    for (double tau = 1.0;; tau = std::min(end, tau * 1.4)) {
        const double begin = now();
        do runner->advance(tau, 4096);
        while (runner->control().waiting == device::Waiting::kSteps);
        computing += now() - begin;
        runner->take_vanished();
        Foam<2> foam;
        runner->download(foam);
        std::printf("| %.3g |", runner->control().clock.time);
        print_spread(foam);
        std::printf(" %lld | %.2f |\n", static_cast<long long>(runner->control().clock.steps), computing);
        std::fflush(stdout);
        if (tau >= end || runner->control().waiting != device::Waiting::kLimit) return;
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (const std::string fault = cuda_fault(); !fault.empty()) {
        std::fprintf(stderr, "%s\n", fault.c_str());
        return 2;
    }
    std::printf("%s\n", cuda_device_name().c_str());
    if (argc > 2 && std::strcmp(argv[1], "phase") == 0) {
        phase_separation(std::atof(argv[2]), argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 0);
        return 0;
    }
    const double seconds = argc > 1 ? std::atof(argv[1]) : 3.0;
    const double copy_rate = cuda_copy_rate(std::size_t{1} << 30);
    std::printf("copying 1 GiB: %.3g bytes/s read and written\n\n", copy_rate);
    std::printf(
        "| | bubbles | bubble-steps/s | bubble-evaluations/s | evaluations per step | bytes/s | of copying |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const int count : {10'000, 100'000, 1'000'000, 10'000'000}) bubble_row<2>(count, seconds, copy_rate);
    for (const int count : {10'000, 100'000, 1'000'000, 10'000'000}) bubble_row<3>(count, seconds, copy_rate);
    std::printf(
        "\n| sum of Biot and Savart, k3 with potential, transfers included | elements | pairs/s |\n|---|---|---|\n");
    for (const bool single : {false, true})
        for (const std::size_t count : {8192UL, 65536UL, 262144UL}) vortex_row(count, single, seconds);
    return 0;
}
