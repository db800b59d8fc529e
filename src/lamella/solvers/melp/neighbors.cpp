#include "lamella/solvers/melp/neighbors.h"

#include "lamella/core/aligned.h"
#include "lamella/core/parallel.h"
#include "lamella/core/simd.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>
#include <array>
#include <numeric>

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

    std::span<const std::uint32_t> order() const { return grid_.order(); }

    /// Adds what lies within reach of the particle at a place of the order to rows of the same and of other regions,
    /// the particle itself, too.
    void add_near(std::size_t at, Rows& same, Rows& other) const {
        const Vec3 position{{position_[0][at], position_[1][at], position_[2][at]}};
        const Vec3 normal{{normal_[0][at], normal_[1][at], normal_[2][at]}};
        // Plain pointers: what is written to rows could else be any of them to the compiler, which reads all anew then.
        const std::array<const double*, 3> x{position_[0].data(), position_[1].data(), position_[2].data()};
        const std::array<const double*, 3> n{normal_[0].data(), normal_[1].data(), normal_[2].data()};
        const double* const regions = region_.data();
        const std::uint32_t* const order = grid_.order().data();
        const Simd far(reach_ * reach_), own(region_[at]);
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

constexpr std::size_t kBlock = 256;

/// Rows that were found in some order of the particles, put into the particles' own.
Neighbors joined(const std::vector<Rows>& blocks, std::span<const std::uint32_t> order, const FilmKernel& kernel) {
    Neighbors all;
    all.kernel = kernel;
    all.start.assign(order.size() + 1, 0);
    parallel_blocks(order.size(), kBlock, [&](std::size_t first, std::size_t last) {
        const std::span<const std::uint32_t> length = blocks[first / kBlock].length();
        for (std::size_t s = first; s < last; ++s) all.start[order[s] + 1] = length[s - first];
    });
    std::partial_sum(all.start.begin(), all.start.end(), all.start.begin());
    all.index.resize(all.start.back());
    all.weight.resize(all.start.back());
    all.laplacian.resize(all.start.back());
    parallel_blocks(order.size(), kBlock, [&](std::size_t first, std::size_t last) {
        const Rows& rows = blocks[first / kBlock];
        RawVector<double> weight(rows.square().size()), laplacian(rows.square().size());
        kernel.weigh(rows.square(), weight, laplacian);
        std::size_t from = 0;
        for (std::size_t s = first; s < last; ++s) {
            const std::size_t to = all.start[order[s]], length = rows.length()[s - first];
            std::copy_n(rows.index().begin() + static_cast<std::ptrdiff_t>(from), length, &all.index[to]);
            std::copy_n(&weight[from], length, &all.weight[to]);
            std::copy_n(&laplacian[from], length, &all.laplacian[to]);
            from += length;
        }
    });
    return all;
}

void tidy(std::vector<RegionPair>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Every two regions that have a pair, ascending.
std::vector<RegionPair> regions_of(const Neighbors& other, std::span<const std::int32_t> region) {
    const std::int32_t regions = region.empty() ? 0 : *std::max_element(region.begin(), region.end()) + 1;
    std::vector<std::vector<RegionPair>> met((region.size() + kBlock - 1) / kBlock);
    parallel_blocks(region.size(), kBlock, [&](std::size_t first, std::size_t last) {
        // Particles of one region mostly stand together: each other one notes by which it was met last.
        std::vector<std::int32_t> by(static_cast<std::size_t>(regions), -1);
        std::vector<RegionPair>& pairs = met[first / kBlock];
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
                const std::int32_t a = region[i], b = region[other.index[k]];
                if (a > b || by[static_cast<std::size_t>(b)] == a) continue;
                by[static_cast<std::size_t>(b)] = a;
                pairs.push_back({a, b});
            }
        tidy(pairs);
    });
    std::vector<RegionPair> all;
    for (const std::vector<RegionPair>& pairs : met) all.insert(all.end(), pairs.begin(), pairs.end());
    tidy(all);
    return all;
}

}  // namespace

NeighborLists find_neighbors(std::span<const Vec3> position,
                             std::span<const Vec3> normal,
                             std::span<const std::int32_t> region,
                             double support_radius) {
    const SortedParticles particles(position, normal, region, support_radius);
    const std::span<const std::uint32_t> order = particles.order();
    std::vector<Rows> same((order.size() + kBlock - 1) / kBlock), other(same.size());
    parallel_blocks(order.size(), kBlock, [&](std::size_t first, std::size_t last) {
        Rows &mine = same[first / kBlock], &theirs = other[first / kBlock];
        for (std::size_t s = first; s < last; ++s) {
            particles.add_near(s, mine, theirs);
            mine.take_out(order[s]);
            mine.close_row();
            theirs.close_row();
        }
    });
    const FilmKernel kernel{support_radius};
    NeighborLists lists{joined(same, order, kernel), joined(other, order, kernel)};
    lists.touching = regions_of(lists.other, region);
    return lists;
}

}  // namespace lamella::melp
