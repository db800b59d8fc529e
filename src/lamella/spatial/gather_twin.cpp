// The CPU twin of the sum over every pair on a GPU.

#include "lamella/spatial/detail/vortex_gather.h"

namespace lamella::spatial::detail {

namespace {

/// What one thread does: part `n / targets` of target `n % targets`.
template <VortexKernel kernel, bool with_potential, class T>
struct GatherTarget {
    GatherProblem problem;

    void operator()(std::size_t n) const {
        const std::size_t i = n % problem.targets;
        const std::size_t part = n / problem.targets;
        TargetSums<kernel, with_potential, T> sums;
        const std::size_t end = problem.parts.end(part);
        for (std::size_t at = problem.parts.begin(part); at < end; at += kGatherTile)
            sums.add_tile(problem.target[i], problem.source + at, end - at < kGatherTile ? end - at : kGatherTile);
        for (std::size_t k = 0; k < 6; ++k) problem.part_sums[(part * 6 + k) * problem.targets + i] = sums.sum[k];
    }
};

}  // namespace

std::array<Column, 6> gather_on_twin(std::span<const Vec3> targets,
                                     std::span<const GatherSource> sources,
                                     const PairLaw& law) {
    HostMachine machine(HostMachine::Order::kShuffled);
    return gather_on(machine, targets, sources, law, [&](HostMachine& m, const GatherProblem& problem) {
        with_law(law, [&]<VortexKernel kernel, bool with_potential, class T>() {
            m.for_each(problem.targets * problem.parts.parts, GatherTarget<kernel, with_potential, T>{problem});
        });
    });
}

}  // namespace lamella::spatial::detail
