#pragma once

#include "lamella/dist/balance.h"
#include "lamella/dist/partition.h"
#include "lamella/solvers/bubble/domain.h"
#include "lamella/spatial/periodic_box.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace lamella::bubble {

/// Which process owns which part of the box; with one process, nothing is asked of it.
template <int D>
class Ownership {
public:
    explicit Ownership(const Domain& domain) : domain_(&domain), balance_(domain.processes()) {}

    /// Held while steps are made: what each process does meanwhile is measured, and who is slower gets fewer bubbles.
    dist::Balance::Working working() { return dist::Balance::Working(balance_); }

    /// Collective. Cuts the box anew where the parts have become unequal, or the box has changed.
    /// @param count      bubbles of this process
    /// @param positions  D columns of their coordinates; asked for only where the box is cut
    using Positions = std::function<std::array<const double*, D>()>;
    void update(const spatial::PeriodicBox<D>& box, std::size_t count, const Positions& positions);

    /// Collective. Every bubble is where it belongs: notes whether the parts are unequal by now.
    /// @param live  bubbles of all processes
    void settle(std::size_t count, std::size_t live);

    int owner(const Vec<D>& x) const { return partition_->owner(x); }
    dist::Part<D> own_part() const { return partition_->part(domain_->processes().rank()); }

    /// The other processes that own a place which a bubble may touch, `reach` from its center, want a copy of it.
    /// @param wanted  for each process the bubbles that it gets
    void want_copies(std::uint32_t bubble,
                     const Vec<D>& center,
                     double reach,
                     std::vector<std::vector<std::uint32_t>>& wanted) const;

private:
    const Domain* domain_;
    std::optional<dist::Partition<D>> partition_;
    Vec<D> partitioned_lengths_;  // of the box that partition_ cuts
    bool unbalanced_ = false;     // partition_ has become so
    dist::Balance balance_;
};

}  // namespace lamella::bubble
