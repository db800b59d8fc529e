#include "lamella/solvers/melp/neighbors.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>

namespace lamella::melp {
namespace {

constexpr double kAgreeing = 0.2;  // least cosine between normals of one film

/// Rows found one block of particles at a time, put behind each other.
struct Rows {
    std::vector<std::uint32_t> length, index;
};

Neighbors joined(std::size_t count, const std::vector<Rows>& blocks) {
    Neighbors all;
    all.start.reserve(count + 1);
    all.start.push_back(0);
    for (const Rows& rows : blocks) {
        for (const std::uint32_t length : rows.length) all.start.push_back(all.start.back() + length);
        all.index.insert(all.index.end(), rows.index.begin(), rows.index.end());
    }
    return all;
}

void weigh(Neighbors& list, std::span<const Vec3> position, const FilmKernel& kernel) {
    list.kernel = kernel;
    list.weight.resize(list.index.size());
    list.laplacian.resize(list.index.size());
    parallel_blocks(list.size(), 256, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t k = list.begin(i); k < list.end(i); ++k) {
                const double square = squared_norm(position[i] - position[list.index[k]]);
                list.weight[k] = kernel.value(square);
                list.laplacian[k] = kernel.laplacian_weight(square);
            }
    });
}

}  // namespace

NeighborLists find_neighbors(std::span<const Vec3> position,
                             std::span<const Vec3> normal,
                             std::span<const std::int32_t> region,
                             double support_radius) {
    const PointGrid grid(position, 0.5 * support_radius);
    constexpr std::size_t kBlock = 256;
    const std::size_t count = position.size();
    std::vector<Rows> same((count + kBlock - 1) / kBlock), other(same.size());
    parallel_blocks(count, kBlock, [&](std::size_t first, std::size_t last) {
        Rows& mine = same[first / kBlock];
        Rows& theirs = other[first / kBlock];
        const auto close_row = [](Rows& rows, std::size_t begin) {
            std::sort(rows.index.begin() + static_cast<std::ptrdiff_t>(begin), rows.index.end());
            rows.length.push_back(static_cast<std::uint32_t>(rows.index.size() - begin));
        };
        for (std::size_t i = first; i < last; ++i) {
            const std::size_t mine_begin = mine.index.size(), theirs_begin = theirs.index.size();
            grid.for_each_within(position[i], support_radius, [&](std::uint32_t j, double) {
                if (j == i) return;
                if (region[i] != region[j])
                    theirs.index.push_back(j);
                else if (dot(normal[i], normal[j]) > kAgreeing)
                    mine.index.push_back(j);
            });
            close_row(mine, mine_begin);
            close_row(theirs, theirs_begin);
        }
    });
    NeighborLists lists{joined(count, same), joined(count, other)};
    const FilmKernel kernel{support_radius};
    weigh(lists.same, position, kernel);
    weigh(lists.other, position, kernel);
    return lists;
}

}  // namespace lamella::melp
