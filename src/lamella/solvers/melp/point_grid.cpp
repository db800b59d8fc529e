#include "lamella/solvers/melp/point_grid.h"

#include "lamella/core/aligned.h"
#include "lamella/core/parallel.h"

#include <algorithm>

namespace lamella::melp {

Bounds bounds_of(std::span<const Vec3> position) {
    if (position.empty()) return {};
    Bounds bounds{position[0], position[0]};
    for (const Vec3& x : position)
        for (std::size_t k = 0; k < 3; ++k) {
            bounds.low[k] = std::min(bounds.low[k], x[k]);
            bounds.high[k] = std::max(bounds.high[k], x[k]);
        }
    return bounds;
}

PointGrid::PointGrid(std::span<const Vec3> position, double cell_edge) {
    if (position.empty()) return;
    const Bounds bounds = bounds_of(position);
    low_ = bounds.low;
    spatial::PeriodicBox<3> box;
    for (std::size_t k = 0; k < 3; ++k) box.lengths[k] = std::max(bounds.high[k] - bounds.low[k], cell_edge);
    std::array<Column, 3> column;
    for (std::size_t k = 0; k < 3; ++k) {
        column[k].resize(position.size());
        parallel_for(position.size(), [&](std::size_t i) { column[k][i] = position[i][k] - low_[k]; });
    }
    const std::array<const double*, 3> columns{column[0].data(), column[1].data(), column[2].data()};
    grid_.emplace(box, columns, position.size(), cell_edge);
}

}  // namespace lamella::melp
