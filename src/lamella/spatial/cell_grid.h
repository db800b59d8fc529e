#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lamella/core/aligned.h"
#include "lamella/core/vec.h"
#include "lamella/spatial/cell_layout.h"
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
        layout_.for_each_run(center, reach,
                             [&](std::size_t first, std::size_t end) { visit(start_[first], start_[end]); });
    }

private:
    CellLayout<D> layout_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> start_;  // of each cell in order_, and the end
};

}  // namespace lamella::spatial
