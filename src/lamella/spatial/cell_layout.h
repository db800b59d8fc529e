#pragma once

#include "lamella/core/vec.h"
#include "lamella/spatial/periodic_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lamella::spatial {

/// The cells of a grid over a box: which of them a point lies in, and which a search touches. Cells are counted row by
/// row, so that neighbors along x follow each other.
template <int D>
class CellLayout {
public:
    CellLayout() = default;
    /// @param edge  wanted edge of a cell; made larger where that would give many more cells than the `count` points
    CellLayout(const PeriodicBox<D>& box, std::size_t count, double edge)
        : box_(box), inverse_lengths_(box.inverse_lengths()) {
        // More cells than points only cost memory: in a nearly empty box the cells grow.
        const double least_edge = std::pow(box.volume() / static_cast<double>(count + 1), 1.0 / D);
        edge = std::max(edge, least_edge);
        for (std::size_t k = 0; k < D; ++k) {
            cells_[k] = static_cast<std::size_t>(std::clamp(std::floor(box.lengths[k] / edge), 1.0, 1e6));
            cells_per_length_[k] = static_cast<double>(cells_[k]) / box.lengths[k];
        }
    }

    LAMELLA_HOST_DEVICE std::size_t count() const {
        std::size_t total = 1;
        for (std::size_t k = 0; k < D; ++k) total *= cells_[k];
        return total;
    }

    /// The cell of a point. Points outside a wall count to the outermost cell; on periodic axes any image will do.
    LAMELLA_HOST_DEVICE std::size_t cell_of(const Vec<D>& x) const {
        std::size_t c = 0;
        for (std::size_t k = D; k-- > 0;) c = c * cells_[k] + cell_on_axis(k, x[k]);
        return c;
    }

    /// Calls visit(first, end) for runs of cells that together hold every point (once) whose nearest image may lie
    /// within `reach` of `center` on each axis.
    template <class Visit>
    LAMELLA_HOST_DEVICE void for_each_run(const Vec<D>& center, double reach, Visit&& visit) const {
        CellRange ranges[D];
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

    LAMELLA_HOST_DEVICE static double limited(double c, double low, double high) {
        return c < low ? low : high < c ? high : c;
    }
    LAMELLA_HOST_DEVICE std::size_t cell_on_axis(std::size_t axis, double x) const {
        x -= box_.lengths[axis] * std::floor(x * inverse_lengths_[axis]);
        const double c = std::floor(x * cells_per_length_[axis]);
        return static_cast<std::size_t>(limited(c, 0.0, static_cast<double>(cells_[axis] - 1)));
    }
    LAMELLA_HOST_DEVICE CellRange range(std::size_t axis, double center, double reach) const {
        const double n = static_cast<double>(cells_[axis]);
        center -= box_.lengths[axis] * std::floor(center * inverse_lengths_[axis]);
        // Rounding may put a point one cell off where it sits on a border; 1e-9 of a cell covers that.
        const double low = std::floor((center - reach) * cells_per_length_[axis] - 1e-9);
        const double high = std::floor((center + reach) * cells_per_length_[axis] + 1e-9);
        if (!box_.periodic[axis]) {
            const double first = limited(low, 0.0, n - 1.0);
            const double last = limited(high, 0.0, n - 1.0);
            return {static_cast<std::size_t>(first), static_cast<std::size_t>(last - first) + 1};
        }
        if (high - low + 1.0 >= n) return {0, cells_[axis]};
        const double first = low < 0.0 ? low + n : low >= n ? low - n : low;
        return {static_cast<std::size_t>(first), static_cast<std::size_t>(high - low) + 1};
    }
    LAMELLA_HOST_DEVICE std::size_t cell(const CellRange& r, std::size_t axis, std::size_t i) const {
        const std::size_t c = r.first + i;
        return c < cells_[axis] ? c : c - cells_[axis];
    }
    template <class Visit>
    LAMELLA_HOST_DEVICE void visit_row(const CellRange& x, std::size_t row, Visit&& visit) const {
        const std::size_t base = row * cells_[0];
        const std::size_t end = x.first + x.count;
        visit(base + x.first, base + (end < cells_[0] ? end : cells_[0]));
        if (end > cells_[0]) visit(base, base + end - cells_[0]);
    }

    PeriodicBox<D> box_;
    std::size_t cells_[D] = {};
    Vec<D> cells_per_length_;
    Vec<D> inverse_lengths_;  // 0 on axes with walls
};

/// Calls found(image) for every periodic image of a ball that is nearer than `limit`: image[k] box lengths are to be
/// subtracted from `separation`.
template <int D, class Found>
LAMELLA_HOST_DEVICE void for_each_image(
    const PeriodicBox<D>& box, const Vec<D>& inverse_lengths, const Vec<D>& separation, double limit, Found&& found) {
    int low[D] = {};
    int high[D] = {};
    for (std::size_t k = 0; k < D; ++k) {
        if (!box.periodic[k]) continue;
        low[k] = static_cast<int>(std::ceil((separation[k] - limit) * inverse_lengths[k]));
        high[k] = static_cast<int>(std::floor((separation[k] + limit) * inverse_lengths[k]));
    }
    int m[D];
    for (std::size_t k = 0; k < D; ++k) {
        m[k] = low[k];
        if (low[k] > high[k]) return;
    }
    while (true) {
        double squared = 0.0;
        std::array<std::int8_t, D> image{};
        for (std::size_t k = 0; k < D; ++k) {
            const double s = separation[k] - box.lengths[k] * m[k];
            squared += s * s;
            image[k] = static_cast<std::int8_t>(m[k]);
        }
        if (squared < limit * limit) found(image);
        std::size_t k = 0;
        while (k < D && ++m[k] > high[k]) {
            m[k] = low[k];
            ++k;
        }
        if (k == D) return;
    }
}

}  // namespace lamella::spatial
