#include "lamella/solvers/melp/point_grid.h"

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
    sorted_.resize(position.size());
    parallel_for(position.size(), [&](std::size_t k) { sorted_[k] = position[grid_->order()[k]]; });
}

void PointGrid::find_within(const Vec3& center, double radius, Found& found) const {
    found.count = 0;
    if (!grid_) return;
    const double most = radius * radius;
    const std::span<const std::uint32_t> order = grid_->order();
    grid_->for_each_range(center - low_, radius, [&](std::uint32_t begin, std::uint32_t end) {
        if (const std::size_t needed = found.count + (end - begin); needed > found.index.size()) {
            found.index.resize(2 * needed);
            found.square.resize(2 * needed);
        }
        // No branch: half of the points are near, in no order that a processor could guess.
        std::size_t count = found.count;
        for (std::uint32_t k = begin; k < end; ++k) {
            const double square = squared_norm(sorted_[k] - center);
            found.index[count] = order[k];
            found.square[count] = square;
            count += square < most ? 1 : 0;
        }
        found.count = count;
    });
}

}  // namespace lamella::melp
