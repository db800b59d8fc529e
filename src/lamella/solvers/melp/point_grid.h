#pragma once

#include "lamella/core/aligned.h"
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

    /// Calls visit(index) for every point within `reach` of `center` on each axis, and some beyond.
    template <class Visit>
    void for_each_near(const Vec3& center, double reach, Visit&& visit) const {
        if (!grid_) return;
        grid_->for_each_range(center - low_, reach, [&](std::uint32_t begin, std::uint32_t end) {
            for (const std::uint32_t i : grid_->order().subspan(begin, end - begin)) visit(i);
        });
    }

    /// Points nearer to a place than a radius. Its memory serves many searches.
    struct Found {
        std::size_t count = 0;
        std::vector<std::uint32_t> index;
        std::vector<double> square;  ///< distance [m^2]
    };
    void find_within(const Vec3& center, double radius, Found& found) const;

private:
    Vec3 low_;                  ///< lower corner of the points
    std::vector<Vec3> sorted_;  ///< the points in the order of the grid
    std::optional<spatial::CellGrid<3>> grid_;
};

/// The corners of the smallest box around points.
struct Bounds {
    Vec3 low, high;
};
Bounds bounds_of(std::span<const Vec3> position);

}  // namespace lamella::melp
