#include "lamella/solvers/bubble/process_plan.h"

#include "lamella/solvers/bubble/shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lamella::bubble {
namespace {

// Of one core of an AMD EPYC, with two processes on two cores (docs/clusters.md); the time per copy is assumed.
template <int D>
constexpr double kSecondsPerBubble = D == 2 ? 3e-8 : 8e-8;
constexpr double kSecondsPerCopy = 2e-8;
constexpr double kLatency = 7e-6;

// Resident memory in bytes per bubble, measured at 1e6 bubbles with frames (docs/clusters.md).
constexpr double kProgramBytes = 38e6;
template <int D>
constexpr double kAlone = D == 2 ? 395.0 : 465.0;
template <int D>
constexpr double kShared = D == 2 ? 440.0 : 620.0;
constexpr double kCopy = 100.0;

/// Mean of q = R^d over the radii of the start, taken as normal.
template <int D>
double mean_size(double mean, double deviation) {
    const double square = mean * mean + deviation * deviation;
    return D == 2 ? square : mean * (square + 2.0 * deviation * deviation);
}

/// About where the largest of `count` normal numbers lies, in standard deviations from the mean.
double largest_deviation(double count) {
    const double root = std::sqrt(2.0 * std::log(std::max(count, 10.0)));
    return root - (std::log(std::log(std::max(count, 10.0))) + std::log(4.0 * std::numbers::pi)) / (2.0 * root);
}

}  // namespace

template <int D>
double halo_share(const Options& options, double processes) {
    if (processes <= 1.0) return 0.0;
    const double mean = options.mean_radius;
    const double deviation = options.start.radius_std;
    const double reach = 2.0 * mean + largest_deviation(options.count) * deviation + options.integrator.skin * mean;
    const double volume = options.count * Shape<D>::kVolume * mean_size<D>(mean, deviation) / options.gas_fraction;
    // Each cut halves the longest edge; along an axis that no cut has met there is nobody else.
    Vec<D> edge;
    double shape = 1.0;
    for (std::size_t k = 0; k < D; ++k) shape *= options.box_shape[k];
    for (std::size_t k = 0; k < D; ++k) edge[k] = options.box_shape[k] * std::pow(volume / shape, 1.0 / D);
    std::array<bool, D> cut{};
    for (double p = 1.0; p < processes; p *= 2.0) {
        std::size_t longest = 0;
        for (std::size_t k = 1; k < D; ++k)
            if (edge[k] > edge[longest]) longest = k;
        edge[longest] *= 0.5;
        cut[longest] = true;
    }
    double around = 1.0;
    for (std::size_t k = 0; k < D; ++k)
        if (cut[k]) around *= 1.0 + 2.0 * reach / edge[k];
    return std::min(around - 1.0, processes - 1.0);
}

template <int D>
double process_memory(const Options& options, double processes) {
    if (processes <= 1.0) return kProgramBytes + options.count * kAlone<D>;
    return kProgramBytes + options.count / processes * (kShared<D> + kCopy * halo_share<D>(options, processes));
}

template <int D>
ProcessPlan plan_processes(const Options& options) {
    constexpr double kWorthIt = 1.25;
    constexpr double kMost = 1 << 20;
    ProcessPlan plan;
    const auto cost = [&](double processes) {
        return options.count / processes *
                   (kSecondsPerBubble<D> + kSecondsPerCopy * halo_share<D>(options, processes)) +
               4.0 * kLatency * std::log2(processes);
    };
    for (double p = 2.0; p <= kMost && cost(p) * p <= kWorthIt * cost(1.0); p *= 2.0) plan.processes = p;
    plan.halo_share = halo_share<D>(options, plan.processes);
    plan.memory_alone = process_memory<D>(options, 1.0);
    plan.memory = process_memory<D>(options, plan.processes);
    return plan;
}

template double halo_share<2>(const Options&, double);
template double halo_share<3>(const Options&, double);
template double process_memory<2>(const Options&, double);
template double process_memory<3>(const Options&, double);
template ProcessPlan plan_processes<2>(const Options&);
template ProcessPlan plan_processes<3>(const Options&);

}  // namespace lamella::bubble
