#include "lamella/solvers/melp/neighbors.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>
#include <utility>

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

void tidy(std::vector<RegionPair>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Pairs of regions that one block of particles meets.
class MetRegions {
public:
    explicit MetRegions(std::size_t regions) : last_(regions, -1) {}

    void meet(std::int32_t a, std::int32_t b) {
        std::int32_t& last = last_[static_cast<std::size_t>(b)];
        if (a > b || last == a) return;
        last = a;
        pairs_.push_back({a, b});
    }
    std::vector<RegionPair> tidied() && {
        tidy(pairs_);
        return std::move(pairs_);
    }

private:
    std::vector<std::int32_t> last_;  // that each was met by: particles of one region mostly stand together
    std::vector<RegionPair> pairs_;
};

}  // namespace

NeighborLists find_neighbors(std::span<const Vec3> position,
                             std::span<const Vec3> normal,
                             std::span<const std::int32_t> region,
                             double support_radius) {
    const PointGrid grid(position, 0.5 * support_radius);
    constexpr std::size_t kBlock = 256;
    const std::size_t count = position.size();
    std::vector<Rows> same((count + kBlock - 1) / kBlock), other(same.size());
    std::vector<std::vector<RegionPair>> met(same.size());
    const std::int32_t regions = region.empty() ? 0 : *std::max_element(region.begin(), region.end()) + 1;
    parallel_blocks(count, kBlock, [&](std::size_t first, std::size_t last) {
        Rows& mine = same[first / kBlock];
        Rows& theirs = other[first / kBlock];
        MetRegions touching(static_cast<std::size_t>(regions));
        PointGrid::Found near;
        for (std::size_t i = first; i < last; ++i) {
            grid.find_within(position[i], support_radius, near);
            for (std::size_t k = 0; k < near.count; ++k) {
                const std::uint32_t j = near.index[k];
                if (j == i) continue;
                if (region[i] != region[j]) {
                    theirs.add(j, near.square[k]);
                    touching.meet(region[i], region[j]);
                } else if (dot(normal[i], normal[j]) > kAgreeing) {
                    mine.add(j, near.square[k]);
                }
            }
            mine.close_row();
            theirs.close_row();
        }
        met[first / kBlock] = std::move(touching).tidied();
    });
    const FilmKernel kernel{support_radius};
    NeighborLists lists{joined(count, same, kernel), joined(count, other, kernel)};
    for (const std::vector<RegionPair>& pairs : met)
        lists.touching.insert(lists.touching.end(), pairs.begin(), pairs.end());
    tidy(lists.touching);
    return lists;
}

}  // namespace lamella::melp
