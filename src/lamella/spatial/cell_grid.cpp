#include "lamella/spatial/cell_grid.h"

#include <algorithm>
#include <cmath>

#include "lamella/core/parallel.h"

namespace lamella::spatial {

template <int D>
CellGrid<D>::CellGrid(const PeriodicBox<D>& box,
                      std::array<const double*, D> position,
                      std::size_t count,
                      double edge)
    : box_(box), inverse_lengths_(box.inverse_lengths()) {
    // More cells than points only cost memory: in a nearly empty box the cells grow.
    const double least_edge = std::pow(box.volume() / static_cast<double>(count + 1), 1.0 / D);
    edge = std::max(edge, least_edge);
    std::size_t total = 1;
    for (std::size_t k = 0; k < D; ++k) {
        cells_[k] = static_cast<std::size_t>(std::clamp(std::floor(box.lengths[k] / edge), 1.0, 1e6));
        cells_per_length_[k] = static_cast<double>(cells_[k]) / box.lengths[k];
        total *= cells_[k];
    }

    std::vector<std::uint32_t> cell_of_point(count);
    parallel_for(count, [&](std::size_t i) {
        std::size_t c = 0;
        for (std::size_t k = D; k-- > 0;) c = c * cells_[k] + cell_of(k, position[k][i]);
        cell_of_point[i] = static_cast<std::uint32_t>(c);
    });

    start_.assign(total + 1, 0);
    for (const std::uint32_t c : cell_of_point) ++start_[c + 1];
    for (std::size_t c = 0; c < total; ++c) start_[c + 1] += start_[c];
    order_.resize(count);
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < count; ++i) order_[next[cell_of_point[i]]++] = static_cast<std::uint32_t>(i);
}

template <int D>
std::size_t CellGrid<D>::cell_of(std::size_t axis, double x) const {
    x -= box_.lengths[axis] * std::floor(x * inverse_lengths_[axis]);
    const double c = std::floor(x * cells_per_length_[axis]);
    return static_cast<std::size_t>(std::clamp(c, 0.0, static_cast<double>(cells_[axis] - 1)));
}

template <int D>
typename CellGrid<D>::CellRange CellGrid<D>::range(std::size_t axis, double center, double reach) const {
    const double n = static_cast<double>(cells_[axis]);
    center -= box_.lengths[axis] * std::floor(center * inverse_lengths_[axis]);
    // Rounding may put a point one cell off where it sits on a border; 1e-9 of a cell covers that.
    const double low = std::floor((center - reach) * cells_per_length_[axis] - 1e-9);
    const double high = std::floor((center + reach) * cells_per_length_[axis] + 1e-9);
    if (!box_.periodic[axis]) {
        const double first = std::clamp(low, 0.0, n - 1.0);
        const double last = std::clamp(high, 0.0, n - 1.0);
        return {static_cast<std::size_t>(first), static_cast<std::size_t>(last - first) + 1};
    }
    if (high - low + 1.0 >= n) return {0, cells_[axis]};
    const double first = low < 0.0 ? low + n : low >= n ? low - n : low;
    return {static_cast<std::size_t>(first), static_cast<std::size_t>(high - low) + 1};
}

template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace lamella::spatial
