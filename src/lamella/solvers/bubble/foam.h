#pragma once

#include "lamella/core/aligned.h"
#include "lamella/core/parallel.h"
#include "lamella/core/vec.h"
#include "lamella/spatial/neighbor_list.h"
#include "lamella/spatial/periodic_box.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lamella::bubble {

template <int D>
using Columns = std::array<Column, D>;

/// Lets go of a column's memory, which `column = {}` keeps for the next values.
template <class C>
void release(C& column) {
    C().swap(column);
}

template <int D>
std::array<const double*, D> pointers(const Columns<D>& columns) {
    std::array<const double*, D> p;
    for (std::size_t k = 0; k < D; ++k) p[k] = columns[k].data();
    return p;
}

/// The bubbles that this process owns. Columns hold `slots` bubbles and spare entries of zeros up to
/// spatial::padded(slots); columns that neighbors read may go on with copies of other processes' bubbles (Domain). A
/// bubble that vanished keeps its slot, with size 0, until the neighbor lists are built anew.
template <int D>
struct Foam {
    spatial::PeriodicBox<D> box;
    std::size_t slots = 0;
    std::size_t live = 0;  ///< bubbles of the whole foam; with several processes most are elsewhere

    Columns<D> position;                               ///< in [0, L) on periodic axes
    Column size;                                       ///< q = R^d; 0: vanished
    Column path_length;                                ///< sum of |dx| over the steps
    Columns<D> start;                                  ///< position at the start
    Columns<D> marked;                                 ///< position at the last frame
    Columns<D> velocity;                               ///< dx/dt at this state
    Column size_rate;                                  ///< dq/dt at this state
    std::array<AlignedVector<std::int32_t>, D> wraps;  ///< how often the bubble left the box at its upper end
    AlignedVector<std::int64_t> id;

    /// The one list of columns that belong to a bubble: reordering, saving and loading use it.
    template <class Self, class Visitor>
    static void for_each_column(Self& self, Visitor&& visit) {
        static constexpr const char* kAxis[] = {"x", "y", "z"};
        visit("id", self.id);
        visit("size", self.size);
        visit("size_rate", self.size_rate);
        visit("path_length", self.path_length);
        for (std::size_t k = 0; k < D; ++k) {
            const std::string axis = kAxis[k];
            visit("position_" + axis, self.position[k]);
            visit("start_" + axis, self.start[k]);
            visit("marked_" + axis, self.marked[k]);
            visit("velocity_" + axis, self.velocity[k]);
            visit("wraps_" + axis, self.wraps[k]);
        }
    }

    void resize(std::size_t count) {
        slots = live = count;
        for_each_column(*this, [&](const std::string&, auto& column) { column.assign(spatial::padded(count), {}); });
    }

    bool alive(std::size_t i) const { return size[i] > 0.0; }
};

/// column[i] = old column[order[i]], then zeros up to `length`.
template <class C>
void reorder(C& column, const std::vector<std::uint32_t>& order, std::size_t length) {
    C sorted(length);
    parallel_for(order.size(), [&](std::size_t i) { sorted[i] = column[order[i]]; });
    column.swap(sorted);
}

}  // namespace lamella::bubble
