#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "lamella/dist/migration.h"
#include "lamella/sim/archive.h"
#include "lamella/solvers/bubble/system.h"

namespace lamella::bubble {

/// The live bubbles by id, so that what leaves the solver depends neither on how bubbles are stored nor on who owns
/// them. Of several processes each holds one stretch of that order, ranks in order.
template <int D>
class IdOrder {
public:
    /// Collective. @param ids  all ids are below this
    IdOrder(const System<D>& system, std::int64_t ids);

    std::size_t count() const { return place_.size(); }  ///< bubbles in this process's stretch
    const sim::Part& part() const { return part_; }      ///< where it lies in the whole

    /// value(slot) of the bubbles of this process's stretch, in order. Collective.
    template <class Value>
    auto column(Value&& value) const {
        using T = std::decay_t<decltype(value(std::size_t{}))>;
        std::vector<T> values(slots_.size());
        parallel_for(slots_.size(), [&](std::size_t n) { values[n] = value(slots_[n]); });
        if (migration_) (*migration_)(values);
        std::vector<T> sorted(place_.size());
        parallel_for(place_.size(), [&](std::size_t n) { sorted[n] = values[place_[n]]; });
        return sorted;
    }

private:
    std::vector<std::uint32_t> slots_;           // of the live bubbles owned here
    std::optional<dist::Migration> migration_;   // to who holds their stretch; empty with one process
    std::vector<std::uint32_t> place_;           // order -> index of what is here then
    sim::Part part_;
};

}  // namespace lamella::bubble
