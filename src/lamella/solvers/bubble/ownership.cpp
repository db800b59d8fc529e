#include "lamella/solvers/bubble/ownership.h"

namespace lamella::bubble {

template <int D>
void Ownership<D>::update(const spatial::PeriodicBox<D>& box, std::size_t count, const Positions& positions) {
    const bool reweighted = balance_.update(count);
    if (partition_ && !unbalanced_ && !reweighted && partitioned_lengths_ == box.lengths) return;
    partition_.emplace(domain_->processes(), box, positions(), count, balance_.weights());
    partitioned_lengths_ = box.lengths;
}

template <int D>
void Ownership<D>::settle(std::size_t count, std::size_t live) {
    constexpr double kWorthANewPartition = 1.05;
    const double most = domain_->largest(static_cast<double>(count) / balance_.share());
    unbalanced_ = most > kWorthANewPartition * static_cast<double>(live);
}

template <int D>
void Ownership<D>::want_copies(std::uint32_t bubble,
                               const Vec<D>& center,
                               double reach,
                               std::vector<std::vector<std::uint32_t>>& wanted) const {
    partition_->for_each_near(center, reach, [&](int rank) {
        if (rank != domain_->processes().rank()) wanted[static_cast<std::size_t>(rank)].push_back(bubble);
    });
}

template class Ownership<2>;
template class Ownership<3>;

}  // namespace lamella::bubble
