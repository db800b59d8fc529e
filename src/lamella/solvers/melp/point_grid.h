#pragma once

#include "lamella/core/vec.h"
#include "lamella/spatial/cell_grid.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella::melp {

/// Points in open space, sorted into cells for searches around a place.
class PointGrid {
public:
    PointGrid(std::span<const Vec3> position, double cell_edge);

    /// Their numbers in the order of the cells.
    std::span<const std::uint32_t> order() const { return grid_ ? grid_->order() : std::span<const std::uint32_t>{}; }

    /// Calls visit(begin, end) for runs of order() that hold every point within `reach` of `center` on each axis, and
    /// some beyond.
    template <class Visit>
    void for_each_run_near(const Vec3& center, double reach, Visit&& visit) const {
        if (grid_) grid_->for_each_range(center - low_, reach, visit);
    }
    /// Calls visit(index) for each of them.
    template <class Visit>
    void for_each_near(const Vec3& center, double reach, Visit&& visit) const {
        for_each_run_near(center, reach, [&](std::uint32_t begin, std::uint32_t end) {
            for (const std::uint32_t i : order().subspan(begin, end - begin)) visit(i);
        });
    }

private:
    Vec3 low_;  ///< lower corner of the points
    std::optional<spatial::CellGrid<3>> grid_;
};

/// The corners of the smallest box around points.
struct Bounds {
    Vec3 low, high;
};
Bounds bounds_of(std::span<const Vec3> position);

}  // namespace lamella::melp
