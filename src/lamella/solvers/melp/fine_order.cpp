#include "lamella/solvers/melp/fine_order.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace lamella::melp {

void sort_fine_particles(FineParticles& fine, double spacing) {
    const Bounds bounds = bounds_of(fine.position);
    struct Key {
        std::int32_t region;
        std::uint64_t code;
        std::uint32_t index;
    };
    std::vector<Key> keys(fine.size());
    constexpr int kBits = 21;
    const double cells = 2.0 / spacing, most = static_cast<double>((1U << kBits) - 1);
    parallel_for(fine.size(), [&](std::size_t p) {
        std::uint64_t code = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto cell = static_cast<std::uint64_t>(std::min(cells * (fine.position[p][k] - bounds.low[k]), most));
            for (unsigned b = 0; b < kBits; ++b) code |= ((cell >> b) & 1U) << (3 * b + k);
        }
        keys[p] = {fine.region[p], code, static_cast<std::uint32_t>(p)};
    });
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return a.region != b.region ? a.region < b.region : a.code != b.code ? a.code < b.code : a.index < b.index;
    });
    FineParticles::for_each_column(fine, [&](const char*, auto& column) {
        auto sorted = column;
        for (std::size_t p = 0; p < keys.size(); ++p) sorted[p] = column[keys[p].index];
        column = std::move(sorted);
    });
}

}  // namespace lamella::melp
