#include "lamella/solvers/melp/neighbors.h"

#include "lamella/core/aligned.h"
#include "lamella/core/parallel.h"
#include "lamella/core/simd.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>
#include <utility>

namespace lamella::melp {
namespace {

constexpr double kAgreeing = 0.2;  // least cosine between normals of one film

/// Rows found one block of particles at a time, put behind each other.
class Rows {
public:
    /// Where the next pairs go, at least `most` of them, and lanes behind them. What is written there belongs to the
    /// row when grow() says so.
    struct Place {
        double* square;
        std::uint32_t* index;
    };
    Place make_room(std::size_t most) {
        if (const std::size_t needed = end_ + most + kLanes; needed > index_.size()) {
            index_.resize(2 * needed);
            square_.resize(2 * needed);
        }
        return {square_.data() + end_, index_.data() + end_};
    }
    void grow(std::size_t pairs) { end_ += pairs; }

    /// Of the row at hand, if it is there.
    void take_out(std::uint32_t j) {
        const std::span<const std::uint32_t> row = row_at_hand();
        const std::size_t at = begin_ + static_cast<std::size_t>(std::find(row.begin(), row.end(), j) - row.begin());
        if (at == end_) return;
        for (std::size_t k = at; k + 1 < end_; ++k) {
            index_[k] = index_[k + 1];
            square_[k] = square_[k + 1];
        }
        --end_;
    }
    void close_row() {
        length_.push_back(static_cast<std::uint32_t>(end_ - begin_));
        begin_ = end_;
    }

    std::span<const std::uint32_t> length() const { return length_; }
    std::span<const std::uint32_t> index() const { return {index_.data(), end_}; }
    std::span<const double> square() const { return {square_.data(), end_}; }  ///< distances of the pairs [m^2]
    std::span<const std::uint32_t> row_at_hand() const { return index().subspan(begin_); }

private:
    std::vector<std::uint32_t> length_;
    RawVector<std::uint32_t> index_;
    RawVector<double> square_;
    std::size_t begin_ = 0, end_ = 0;  // of the row at hand
};

/// Particles in the order of a grid's cells: a search reads eight of them at a time, one behind the other.
class SortedParticles {
public:
    SortedParticles(std::span<const Vec3> position,
                    std::span<const Vec3> normal,
                    std::span<const std::int32_t> region,
                    double support_radius)
        : reach_(support_radius), grid_(position, 0.5 * support_radius), region_(position.size() + kLanes) {
        for (std::size_t c = 0; c < 3; ++c) {  // behind the last one stand lanes that nobody counts
            position_[c].resize(region_.size());
            normal_[c].resize(region_.size());
        }
        parallel_for(position.size(), [&](std::size_t s) {
            const std::uint32_t i = grid_.order()[s];
            for (std::size_t c = 0; c < 3; ++c) {
                position_[c][s] = position[i][c];
                normal_[c][s] = normal[i][c];
            }
            region_[s] = region[i];
        });
    }

    /// Adds what lies within reach to rows of the same and of other regions, the particle itself, too.
    void add_near(const Vec3& position, const Vec3& normal, std::int32_t region, Rows& same, Rows& other) const {
        // Plain pointers: what is written to rows could else be any of them to the compiler, which reads all anew then.
        const std::array<const double*, 3> x{position_[0].data(), position_[1].data(), position_[2].data()};
        const std::array<const double*, 3> n{normal_[0].data(), normal_[1].data(), normal_[2].data()};
        const double* const regions = region_.data();
        const std::uint32_t* const order = grid_.order().data();
        const Simd far(reach_ * reach_), own(region);
        grid_.for_each_run_near(
            position, reach_, [&, x, n, regions, order, far, own](std::size_t begin, std::size_t end) {
                const Rows::Place mine = same.make_room(end - begin), theirs = other.make_room(end - begin);
                std::size_t near = 0, strange = 0;
                for (std::size_t s = begin; s < end; s += kLanes) {
                    Simd square{}, cosine{};
                    for (std::size_t c = 0; c < 3; ++c) {
                        const Simd d = load_lanes(x[c] + s) - position[c];
                        square += d * d;
                        cosine += normal[c] * load_lanes(n[c] + s);
                    }
                    const auto related = load_lanes(regions + s) == own;
                    const std::size_t count = std::min(end - s, kLanes);
                    near += pack_smaller(select(related && cosine > kAgreeing, square, far), reach_ * reach_, order + s,
                                         count, mine.square + near, mine.index + near);
                    strange += pack_smaller(select(related, far, square), reach_ * reach_, order + s, count,
                                            theirs.square + strange, theirs.index + strange);
                }
                same.grow(near);
                other.grow(strange);
            });
    }

private:
    double reach_;
    PointGrid grid_;
    std::array<Column, 3> position_, normal_;
    Column region_;
};

Neighbors joined(std::size_t count, const std::vector<Rows>& blocks, const FilmKernel& kernel) {
    Neighbors all;
    all.kernel = kernel;
    all.start.reserve(count + 1);
    all.start.push_back(0);
    std::vector<std::size_t> first;
    for (const Rows& rows : blocks) {
        first.push_back(all.start.back());
        for (const std::uint32_t length : rows.length()) all.start.push_back(all.start.back() + length);
    }
    all.index.resize(all.start.back());
    all.weight.resize(all.start.back());
    all.laplacian.resize(all.start.back());
    parallel_blocks(blocks.size(), 1, [&](std::size_t b, std::size_t) {
        const std::span<const std::uint32_t> index = blocks[b].index();
        std::copy(index.begin(), index.end(), all.index.begin() + static_cast<std::ptrdiff_t>(first[b]));
        kernel.weigh(blocks[b].square(), {all.weight.data() + first[b], index.size()},
                     {all.laplacian.data() + first[b], index.size()});
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
    const SortedParticles particles(position, normal, region, support_radius);
    constexpr std::size_t kBlock = 256;
    const std::size_t count = position.size();
    std::vector<Rows> same((count + kBlock - 1) / kBlock), other(same.size());
    std::vector<std::vector<RegionPair>> met(same.size());
    const std::int32_t regions = region.empty() ? 0 : *std::max_element(region.begin(), region.end()) + 1;
    parallel_blocks(count, kBlock, [&](std::size_t first, std::size_t last) {
        Rows& mine = same[first / kBlock];
        Rows& theirs = other[first / kBlock];
        MetRegions touching(static_cast<std::size_t>(regions));
        for (std::size_t i = first; i < last; ++i) {
            particles.add_near(position[i], normal[i], region[i], mine, theirs);
            mine.take_out(static_cast<std::uint32_t>(i));
            for (const std::uint32_t j : theirs.row_at_hand()) touching.meet(region[i], region[j]);
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
