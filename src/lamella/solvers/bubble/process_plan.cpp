#include "lamella/solvers/bubble/process_plan.h"

#include "lamella/solvers/bubble/shape.h"

#include <cmath>

namespace lamella::bubble {
namespace {

// The first is of one core of a shared machine (docs/performance.md); the others are assumed, nothing has checked them.
template <int D>
constexpr double kSecondsPerBubble = D == 2 ? 6e-8 : 1.2e-7;
constexpr double kSecondsPerCopy = 2e-8;
constexpr double kLatency = 3e-6;

}  // namespace

template <int D>
double halo_share(const Options& options, double processes) {
    if (processes <= 1.0) return 0.0;
    const double mean = options.mean_radius;
    const double largest = mean + 3.5 * options.start.radius_std;
    const double reach = mean + largest + options.integrator.skin * mean;
    const double volume = options.count * Shape<D>::kVolume * Shape<D>::size(mean) / options.gas_fraction;
    const double edge = std::pow(volume / processes, 1.0 / D);
    return std::min(std::pow(1.0 + 2.0 * reach / edge, D) - 1.0, processes - 1.0);
}

template <int D>
ProcessPlan plan_processes(const Options& options) {
    constexpr double kWorthIt = 1.25;
    constexpr double kMost = 1 << 20;
    ProcessPlan plan;
    plan.bytes_per_bubble = D == 2 ? 290.0 : 420.0;
    const auto cost = [&](double processes) {
        return options.count / processes *
                   (kSecondsPerBubble<D> + kSecondsPerCopy * halo_share<D>(options, processes)) +
               4.0 * kLatency * std::log2(processes);
    };
    for (double p = 2.0; p <= kMost && cost(p) * p <= kWorthIt * cost(1.0); p *= 2.0) plan.processes = p;
    plan.halo_share = halo_share<D>(options, plan.processes);
    // A copy has an entry in the four or five columns that neighbors read.
    plan.memory = options.count / plan.processes * (plan.bytes_per_bubble + plan.halo_share * (D == 2 ? 60.0 : 80.0));
    return plan;
}

template double halo_share<2>(const Options&, double);
template double halo_share<3>(const Options&, double);
template ProcessPlan plan_processes<2>(const Options&);
template ProcessPlan plan_processes<3>(const Options&);

}  // namespace lamella::bubble
