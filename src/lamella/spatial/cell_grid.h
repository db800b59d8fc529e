#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lamella/core/aligned.h"
#include "lamella/core/vec.h"
#include "lamella/spatial/periodic_box.h"

namespace lamella::spatial {

/// Points sorted into a grid of small cells, row by row, so that the points of neighboring cells of a row stand
/// next to each other in memory. A search visits only the cells that its own reach touches.
template <int D>
class CellGrid {
public:
    /// Sorts the points. Points outside a wall count to the outermost cell; on periodic axes any image will do.
    /// @param position  D columns of `count` coordinates
    /// @param edge      wanted edge of a cell; made larger where that would give many more cells than points
    CellGrid(const PeriodicBox<D>& box, std::array<const double*, D> position, std::size_t count, double edge);

    /// Storage index of the points in cell order.
    std::span<const std::uint32_t> order() const { return order_; }

    /// Calls visit(begin, end) for ranges of order() that together hold every point (once) whose nearest image may
    /// lie within `reach` of `center` on each axis.
    template <class Visit>
    void for_each_range(const Vec<D>& center, double reach, Visit&& visit) const {
        std::array<CellRange, D> ranges;
        for (std::size_t k = 0; k < D; ++k) ranges[k] = range(k, center[k], reach);
        if constexpr (D == 2) {
            for (std::size_t y = 0; y < ranges[1].count; ++y) visit_row(ranges[0], cell(ranges[1], 1, y), visit);
        } else {
            for (std::size_t z = 0; z < ranges[2].count; ++z)
                for (std::size_t y = 0; y < ranges[1].count; ++y)
                    visit_row(ranges[0], cell(ranges[2], 2, z) * cells_[1] + cell(ranges[1], 1, y), visit);
        }
    }

private:
    struct CellRange {
        std::size_t first, count;  // cells first, first + 1, ... (wrapped around on periodic axes)
    };

    CellRange range(std::size_t axis, double center, double reach) const;
    std::size_t cell_of(std::size_t axis, double x) const;
    std::size_t cell(const CellRange& r, std::size_t axis, std::size_t i) const {
        const std::size_t c = r.first + i;
        return c < cells_[axis] ? c : c - cells_[axis];
    }
    template <class Visit>
    void visit_row(const CellRange& x, std::size_t row, Visit&& visit) const {
        const std::size_t base = row * cells_[0];
        const std::size_t end = x.first + x.count;
        const std::size_t straight = end < cells_[0] ? end : cells_[0];
        visit(start_[base + x.first], start_[base + straight]);
        if (end > cells_[0]) visit(start_[base], start_[base + end - cells_[0]]);
    }

    PeriodicBox<D> box_;
    std::array<std::size_t, D> cells_;
    Vec<D> cells_per_length_;
    Vec<D> inverse_lengths_;  // 0 on axes with walls
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> start_;  // of each cell in order_, and the end
};

}  // namespace lamella::spatial
