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
    std::vector<double> square;  // distance of the pair [m^2]

    void close_row() {
        length.push_back(static_cast<std::uint32_t>(index.size() - begin_));
        begin_ = index.size();
    }
    void add(std::uint32_t j, double squared_distance) {
        index.push_back(j);
        square.push_back(squared_distance);
    }

private:
    std::size_t begin_ = 0;
};

Neighbors joined(std::size_t count, const std::vector<Rows>& blocks, const FilmKernel& kernel) {
    Neighbors all;
    all.kernel = kernel;
    all.start.reserve(count + 1);
    all.start.push_back(0);
    std::vector<std::size_t> first;
    for (const Rows& rows : blocks) {
        first.push_back(all.start.back());
        for (const std::uint32_t length : rows.length) all.start.push_back(all.start.back() + length);
    }
    all.index.resize(all.start.back());
    all.weight.resize(all.start.back());
    all.laplacian.resize(all.start.back());
    parallel_blocks(blocks.size(), 1, [&](std::size_t b, std::size_t) {
        const Rows& rows = blocks[b];
        std::copy(rows.index.begin(), rows.index.end(), all.index.begin() + static_cast<std::ptrdiff_t>(first[b]));
        kernel.weigh(rows.square, {all.weight.data() + first[b], rows.square.size()},
                     {all.laplacian.data() + first[b], rows.square.size()});
    });
    return all;
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
        PointGrid::Found near;
        for (std::size_t i = first; i < last; ++i) {
            grid.find_within(position[i], support_radius, near);
            for (std::size_t k = 0; k < near.count; ++k) {
                const std::uint32_t j = near.index[k];
                if (j == i) continue;
                if (region[i] != region[j])
                    theirs.add(j, near.square[k]);
                else if (dot(normal[i], normal[j]) > kAgreeing)
                    mine.add(j, near.square[k]);
            }
            mine.close_row();
            theirs.close_row();
        }
    });
    const FilmKernel kernel{support_radius};
    return {joined(count, same, kernel), joined(count, other, kernel)};
}

std::vector<std::array<std::int32_t, 2>> touching_regions(const Neighbors& other,
                                                          std::span<const std::int32_t> region) {
    using Pair = std::array<std::int32_t, 2>;
    constexpr std::size_t kBlock = 1024;
    std::vector<std::vector<Pair>> found((other.size() + kBlock - 1) / kBlock);
    const auto tidy = [](std::vector<Pair>& pairs) {
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    };
    const std::int32_t regions = region.empty() ? 0 : *std::max_element(region.begin(), region.end()) + 1;
    parallel_blocks(other.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        std::vector<Pair>& mine = found[begin / kBlock];
        // The last region that each was noted with: particles of one mostly stand together.
        std::vector<std::int32_t> noted(static_cast<std::size_t>(regions), -1);
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
                const std::int32_t a = region[i], b = region[other.index[k]];
                if (a > b || noted[static_cast<std::size_t>(b)] == a) continue;
                noted[static_cast<std::size_t>(b)] = a;
                mine.push_back({a, b});
            }
        tidy(mine);
    });
    std::vector<Pair> all;
    for (const std::vector<Pair>& pairs : found) all.insert(all.end(), pairs.begin(), pairs.end());
    tidy(all);
    return all;
}

}  // namespace lamella::melp
