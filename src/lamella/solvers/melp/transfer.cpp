// Which fine and coarse particles see each other, and how much.

#include "lamella/solvers/melp/transfer.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/point_grid.h"
#include "lamella/solvers/melp/transfer_lanes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::melp {
namespace {

constexpr double kAgreeing = 0.2;  // least cosine between the normals of a fine and a coarse particle

double squared_distance(const Bounds& box, const Vec3& x) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double out = std::max({box.low[k] - x[k], x[k] - box.high[k], 0.0});
        sum += out * out;
    }
    return sum;
}

/// The shape of FilmKernel as a function of s = 3 d / r; sums are normalized, so its scale is free.
inline double spline(double s) {
    return fifth_power(std::max(3.0 - s, 0.0)) - 6.0 * fifth_power(std::max(2.0 - s, 0.0)) +
           15.0 * fifth_power(std::max(1.0 - s, 0.0));
}

}  // namespace

Transfer::Transfer(const CoarseParticles& coarse,
                   std::span<const Vec3> normal,
                   const FineParticles& fine,
                   double support_radius,
                   const Images& images)
    : support_radius_(support_radius), inverse_sum_(fine.size(), 0.0) {
    for (std::size_t m = 0; m < images.mirrors.size(); ++m) pictures_.push_back({images.source[m], images.mirrors[m]});
    const std::vector<Vec3> place = places_with_pictures(coarse.position);
    std::vector<Vec3> facing(normal.begin(), normal.end());
    std::vector<std::int32_t> region = coarse.region;
    for (const Picture& picture : pictures_) {
        facing.push_back(picture.mirror.normal(normal[picture.source]));
        region.push_back(coarse.region[picture.source]);
    }
    for (std::size_t first = 0; first < fine.size();) {
        Chunk chunk;
        while (chunk.block.size() < kBlocks && first < fine.size() &&
               (chunk.block.empty() || fine.region[first] == fine.region[chunk.block[0].first])) {
            std::size_t last = first;
            while (last < fine.size() && last - first < kLanes && fine.region[last] == fine.region[first]) ++last;
            chunk.block.push_back(
                {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last - first), 0, 0, 0});
            first = last;
        }
        chunks_.push_back(std::move(chunk));
    }
    const PointGrid grid(place, support_radius);
    parallel_blocks(chunks_.size(), 1, [&](std::size_t c, std::size_t) {
        Chunk& chunk = chunks_[c];
        const std::size_t first = chunk.block.front().first, last = chunk.block.back().first + chunk.block.back().count;
        const Bounds box = bounds_of(std::span(fine.position).subspan(first, last - first));
        const double reach = support_radius + 0.5 * norm(box.high - box.low);
        grid.for_each_near(0.5 * (box.low + box.high), reach, [&](std::uint32_t e) {
            if (region[e] == fine.region[first] && squared_distance(box, place[e]) < support_radius * support_radius)
                chunk.coarse.push_back(e);
        });
        std::sort(chunk.coarse.begin(), chunk.coarse.end());
        find(chunk, place, facing, fine);
    });

    places_start_.assign(place.size() + 1, 0);
    for (const Chunk& chunk : chunks_)
        for (const std::uint32_t e : chunk.coarse) ++places_start_[e + 1];
    std::partial_sum(places_start_.begin(), places_start_.end(), places_start_.begin());
    places_.resize(places_start_.back());
    std::vector<std::uint32_t> next(places_start_.begin(), places_start_.end() - 1);
    for (std::size_t c = 0; c < chunks_.size(); ++c)
        for (std::size_t k = 0; k < chunks_[c].coarse.size(); ++k)
            places_[next[chunks_[c].coarse[k]]++] = {static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(k)};
}

/// Of coarse particles, and behind them of their pictures [m].
std::vector<Vec3> Transfer::places_with_pictures(std::span<const Vec3> position) const {
    std::vector<Vec3> place(position.begin(), position.end());
    for (const Picture& picture : pictures_) place.push_back(picture.mirror.place(position[picture.source]));
    return place;
}

void Transfer::find(Chunk& chunk,
                    std::span<const Vec3> position,
                    std::span<const Vec3> normal,
                    const FineParticles& fine) {
    const double scale = 3.0 / support_radius_;
    const std::size_t coarse_count = position.size() - pictures_.size();
    std::array<Lanes, 3> x, n;
    for (Block& block : chunk.block) {
        block.candidates = static_cast<std::uint32_t>(chunk.candidate.size());
        block.weights = static_cast<std::uint32_t>(chunk.weight.size() / kLanes);
        load_lanes<kLanes>(fine.position, block.first, block.count, x);
        load_lanes<kLanes>(fine.normal, block.first, block.count, n);
        const Bounds box = bounds_of(std::span(fine.position).subspan(block.first, block.count));
        Lanes sum{};
        for (std::size_t k = 0; k < chunk.coarse.size(); ++k) {
            const Vec3& y = position[chunk.coarse[k]];
            if (squared_distance(box, y) >= support_radius_ * support_radius_) continue;
            const Vec3& m = normal[chunk.coarse[k]];
            const double root =
                chunk.coarse[k] < coarse_count ? 1.0 : pictures_[chunk.coarse[k] - coarse_count].mirror.root;
            const double narrowed = root * root;
            chunk.candidate.push_back(static_cast<std::uint32_t>(k));
            const std::size_t row = chunk.weight.size();
            chunk.weight.resize(row + kLanes);
            float* weight = &chunk.weight[row];
            for (std::size_t l = 0; l < kLanes; ++l) {
                const double dx = x[0][l] - y[0], dy = x[1][l] - y[1], dz = x[2][l] - y[2];
                const double w = spline(scale * std::sqrt(dx * dx + dy * dy + dz * dz));
                const double cosine = n[0][l] * m[0] + n[1][l] * m[1] + n[2][l] * m[2];
                weight[l] = static_cast<float>(cosine > kAgreeing ? narrowed * w : 0.0);
                sum[l] += static_cast<double>(weight[l]);
            }
        }
        block.rows = static_cast<std::uint32_t>(chunk.candidate.size()) - block.candidates;
        for (std::size_t l = 0; l < block.count; ++l) inverse_sum_[block.first + l] = sum[l] > 0.0 ? 1.0 / sum[l] : 0.0;
    }
}

std::size_t Transfer::strays() const {
    return static_cast<std::size_t>(std::count(inverse_sum_.begin(), inverse_sum_.end(), 0.0));
}

std::size_t Transfer::pairs() const {
    std::size_t count = 0;
    for (const Chunk& chunk : chunks_)
        for (const Block& block : chunk.block)
            for (std::size_t row = 0; row < block.rows; ++row)
                for (std::size_t l = 0; l < block.count; ++l)
                    count += chunk.weight[(block.weights + row) * kLanes + l] != 0.0F ? 1 : 0;
    return count;
}

std::size_t Transfer::places() const {
    std::size_t count = 0;
    for (const Chunk& chunk : chunks_) count += chunk.weight.size();
    return count;
}

}  // namespace lamella::melp
