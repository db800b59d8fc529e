#include "lamella/spatial/cell_grid.h"

#include "lamella/core/parallel.h"

namespace lamella::spatial {

template <int D>
CellGrid<D>::CellGrid(const PeriodicBox<D>& box,
                      std::array<const double*, D> position,
                      std::size_t count,
                      double edge)
    : layout_(box, count, edge) {
    std::vector<std::uint32_t> cell_of_point(count);
    parallel_for(count, [&](std::size_t i) {
        Vec<D> x;
        for (std::size_t k = 0; k < D; ++k) x[k] = position[k][i];
        cell_of_point[i] = static_cast<std::uint32_t>(layout_.cell_of(x));
    });

    const std::size_t total = layout_.count();
    start_.assign(total + 1, 0);
    for (const std::uint32_t c : cell_of_point) ++start_[c + 1];
    for (std::size_t c = 0; c < total; ++c) start_[c + 1] += start_[c];
    order_.resize(count);
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < count; ++i) order_[next[cell_of_point[i]]++] = static_cast<std::uint32_t>(i);
}

template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace lamella::spatial
