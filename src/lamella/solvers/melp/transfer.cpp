#include "lamella/solvers/melp/transfer.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::melp {
namespace {

constexpr double kAgreeing = 0.2;  // least cosine between the normals of a fine and a coarse particle

/// One component of a vector column for the lanes of a block; lanes that are not there repeat the last particle.
template <std::size_t N>
void load(std::span<const Vec3> column,
          std::size_t first,
          std::size_t count,
          std::array<std::array<double, N>, 3>& to) {
    for (std::size_t l = 0; l < N; ++l) {
        const Vec3& x = column[first + std::min(l, count - 1)];
        for (std::size_t k = 0; k < 3; ++k) to[k][l] = x[k];
    }
}

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
        load<kLanes>(fine.position, block.first, block.count, x);
        load<kLanes>(fine.normal, block.first, block.count, n);
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

/// What pictures have received is their particles', momentum turned back.
void Transfer::hand_in_pictures(Gathered& gathered) const {
    const std::size_t count = gathered.liquid_volume.size() - pictures_.size();
    for (std::size_t m = 0; m < pictures_.size(); ++m) {
        const auto& [source, mirror] = pictures_[m];
        const double volume = gathered.liquid_volume[count + m];
        gathered.liquid_volume[source] += volume;
        gathered.surfactant[source] += gathered.surfactant[count + m];
        gathered.seen_volume[source] += gathered.seen_volume[count + m];
        const Vec3 w = gathered.momentum[count + m] - volume * mirror.drift;
        gathered.momentum[source] += w[0] * mirror.map[0] + w[1] * mirror.map[1] + w[2] * mirror.map[2];
    }
    gathered.liquid_volume.resize(count);
    gathered.surfactant.resize(count);
    gathered.seen_volume.resize(count);
    gathered.momentum.resize(count);
}

Gathered Transfer::to_coarse(const CoarseParticles& coarse, const FineParticles& fine) const {
    // What a fine particle gives, all times its weight: volume, surfactant, seen volume, momentum at the chunk's origin
    // and its gradient (9), and one spare to fill two rows of eight.
    constexpr std::size_t kGiven = 16, kKept = 6;
    const std::vector<Vec3> place = places_with_pictures(coarse.position);
    std::vector<std::vector<double>> received(chunks_.size());  // kKept per coarse particle of the chunk
    parallel_blocks(chunks_.size(), 1, [&](std::size_t c, std::size_t) {
        const Chunk& chunk = chunks_[c];
        const Vec3 origin = fine.position[chunk.block.front().first];
        std::vector<std::array<double, kGiven>> sum(chunk.coarse.size());
        std::array<std::array<double, kGiven>, kLanes> given;
        for (const Block& block : chunk.block) {
            for (std::size_t l = 0; l < block.count; ++l) {
                const std::size_t p = block.first + l;
                const double v = fine.liquid_volume[p] * inverse_sum_[p];
                const Vec3 at_origin = fine.velocity[p] - fine.gradient[p] * (fine.position[p] - origin);
                given[l] = {v, fine.surfactant[p] * inverse_sum_[p], v * fine.thickness[p]};
                for (std::size_t k = 0; k < 3; ++k) {
                    given[l][3 + k] = v * at_origin[k];
                    for (std::size_t m = 0; m < 3; ++m) given[l][6 + 3 * k + m] = v * fine.gradient[p][k][m];
                }
            }
            for (std::size_t row = 0; row < block.rows; ++row) {
                const float* weight = &chunk.weight[(block.weights + row) * kLanes];
                auto& to = sum[chunk.candidate[block.candidates + row]];
                for (std::size_t l = 0; l < block.count; ++l) {
                    const double w = static_cast<double>(weight[l]);
                    if (w == 0.0) continue;
                    for (std::size_t q = 0; q < kGiven; ++q) to[q] += w * given[l][q];
                }
            }
        }
        received[c].resize(kKept * chunk.coarse.size());
        for (std::size_t k = 0; k < chunk.coarse.size(); ++k) {
            const Vec3 d = place[chunk.coarse[k]] - origin;
            double* to = &received[c][kKept * k];
            for (std::size_t q = 0; q < 3; ++q) to[q] = sum[k][q];
            for (std::size_t q = 0; q < 3; ++q)
                to[3 + q] =
                    sum[k][3 + q] + sum[k][6 + 3 * q] * d[0] + sum[k][7 + 3 * q] * d[1] + sum[k][8 + 3 * q] * d[2];
        }
    });

    Gathered gathered;
    gathered.liquid_volume.resize(place.size());
    gathered.surfactant.resize(place.size());
    gathered.seen_volume.resize(place.size());
    gathered.momentum.resize(place.size());
    parallel_for(place.size(), [&](std::size_t e) {
        std::array<double, kKept> sum{};
        for (std::size_t k = places_start_[e]; k < places_start_[e + 1]; ++k)
            for (std::size_t q = 0; q < kKept; ++q) sum[q] += received[places_[k][0]][kKept * places_[k][1] + q];
        gathered.liquid_volume[e] = sum[0];
        gathered.surfactant[e] = sum[1];
        gathered.seen_volume[e] = sum[2];
        gathered.momentum[e] = {{sum[3], sum[4], sum[5]}};
    });
    hand_in_pictures(gathered);
    return gathered;
}

namespace {

/// B D^-1 in the tangent plane of a fine particle. [method sheet 5 R]
///
/// @param moment  B, three rows   @param spread  D, of the coarse particles about their mean
/// @param floor   added to D in the plane [m^2]: a fine particle that sees only coarse ones on a line gets no gradient
///                across it
/// @param mean    of the coarse particles seen from the fine one [m]. One that lies farther outside of them than edges
///                let it, in their standard deviations, would be thrown by a gradient that they know badly: it gets
///                less of it.
Tensor affine_map(const Tensor& moment, const Tensor& spread, const Vec3& normal, double floor, const Vec3& mean) {
    constexpr double kFarthest = 2.0;  // 1.2 on a straight edge, 1.7 in a corner
    const Frame f = frame_of(normal);
    const Vec3 s1 = spread * f.e1, s2 = spread * f.e2;
    const double uu = dot(f.e1, s1) + floor, uv = dot(f.e1, s2), vv = dot(f.e2, s2) + floor;
    const double determinant = uu * vv - uv * uv;
    const Vec3 row1 = (vv / determinant) * f.e1 - (uv / determinant) * f.e2;
    const Vec3 row2 = (uu / determinant) * f.e2 - (uv / determinant) * f.e1;
    const double outside = dot(f.e1, mean) * dot(row1, mean) + dot(f.e2, mean) * dot(row2, mean);
    const double part = outside > kFarthest * kFarthest ? kFarthest / std::sqrt(outside) : 1.0;
    const Vec3 b1 = part * (moment * f.e1), b2 = part * (moment * f.e2);
    Tensor map;
    for (std::size_t k = 0; k < 3; ++k) map[k] = b1[k] * row1 + b2[k] * row2;
    return map;
}

}  // namespace

void Transfer::to_fine(const CoarseValues& from, double rate, FineParticles& fine) const {
    // Sums over the coarse particles, a row of lanes each: d (3), u (3), d d (6), u d (9), eta, seen eta.
    constexpr std::size_t kSums = 23;
    const double floor = 1e-4 * support_radius_ * support_radius_;
    const std::vector<Vec3> place = places_with_pictures(from.position);
    std::vector<Vec3> velocity(from.velocity.begin(), from.velocity.end());
    std::vector<double> thickness(from.thickness.begin(), from.thickness.end());
    std::vector<double> seen_thickness(from.seen_thickness.begin(), from.seen_thickness.end());
    for (const auto& [source, mirror] : pictures_) {
        velocity.push_back(mirror.velocity(from.velocity[source]));
        thickness.push_back(from.thickness[source]);
        seen_thickness.push_back(from.seen_thickness[source]);
    }
    parallel_blocks(chunks_.size(), 1, [&](std::size_t c, std::size_t) {
        const Chunk& chunk = chunks_[c];
        std::array<Lanes, 3> x;
        for (const Block& block : chunk.block) {
            load<kLanes>(fine.position, block.first, block.count, x);
            std::array<Lanes, kSums> sum{};
            for (std::size_t row = 0; row < block.rows; ++row) {
                const float* weight = &chunk.weight[(block.weights + row) * kLanes];
                const std::uint32_t e = chunk.coarse[chunk.candidate[block.candidates + row]];
                const Vec3 y = place[e], u = velocity[e];
                const double eta = thickness[e], seen = seen_thickness[e];
                for (std::size_t l = 0; l < kLanes; ++l) {
                    const double w = static_cast<double>(weight[l]);
                    const double d0 = y[0] - x[0][l], d1 = y[1] - x[1][l], d2 = y[2] - x[2][l];
                    const double w0 = w * d0, w1 = w * d1, w2 = w * d2;
                    sum[0][l] += w0;
                    sum[1][l] += w1;
                    sum[2][l] += w2;
                    sum[3][l] += w * u[0];
                    sum[4][l] += w * u[1];
                    sum[5][l] += w * u[2];
                    sum[6][l] += w0 * d0;
                    sum[7][l] += w0 * d1;
                    sum[8][l] += w0 * d2;
                    sum[9][l] += w1 * d1;
                    sum[10][l] += w1 * d2;
                    sum[11][l] += w2 * d2;
                    sum[12][l] += w0 * u[0];
                    sum[13][l] += w1 * u[0];
                    sum[14][l] += w2 * u[0];
                    sum[15][l] += w0 * u[1];
                    sum[16][l] += w1 * u[1];
                    sum[17][l] += w2 * u[1];
                    sum[18][l] += w0 * u[2];
                    sum[19][l] += w1 * u[2];
                    sum[20][l] += w2 * u[2];
                    sum[21][l] += w * eta;
                    sum[22][l] += w * seen;
                }
            }
            for (std::size_t l = 0; l < block.count; ++l) {
                const std::size_t p = block.first + l;
                const double scale = inverse_sum_[p];
                if (scale == 0.0) continue;
                const auto mean = [&](std::size_t q) { return scale * sum[q][l]; };
                const Vec3 d{{mean(0), mean(1), mean(2)}}, u{{mean(3), mean(4), mean(5)}};
                Tensor spread{Vec3{{mean(6), mean(7), mean(8)}}, Vec3{{mean(7), mean(9), mean(10)}},
                              Vec3{{mean(8), mean(10), mean(11)}}};
                Tensor moment{Vec3{{mean(12), mean(13), mean(14)}}, Vec3{{mean(15), mean(16), mean(17)}},
                              Vec3{{mean(18), mean(19), mean(20)}}};
                for (std::size_t k = 0; k < 3; ++k) {
                    spread[k] -= d[k] * d;
                    moment[k] -= u[k] * d;
                }
                fine.gradient[p] = affine_map(moment, spread, fine.normal[p], floor, d);
                fine.velocity[p] = u - fine.gradient[p] * d;
                fine.thickness[p] += rate * (mean(21) - mean(22));
            }
        }
    });
}

void Transfer::project(std::span<const Patch> patch, std::span<const Vec3> normal, FineParticles& fine) const {
    parallel_blocks(chunks_.size(), 1, [&](std::size_t c, std::size_t) {
        const Chunk& chunk = chunks_[c];
        std::array<Lanes, 3> x;
        for (const Block& block : chunk.block) {
            load<kLanes>(fine.position, block.first, block.count, x);
            std::array<Lanes, 3> shift{}, blended{};
            Lanes all{};
            for (std::size_t row = 0; row < block.rows; ++row) {
                const float* weight = &chunk.weight[(block.weights + row) * kLanes];
                const std::uint32_t e = chunk.coarse[chunk.candidate[block.candidates + row]];
                if (e >= patch.size()) continue;  // a picture: the film is before it
                const Patch q = patch[e];
                const Vec3 n = normal[e];
                for (std::size_t l = 0; l < kLanes; ++l) {
                    const double w = static_cast<double>(weight[l]);
                    all[l] += w;
                    const double above = w * q.above({{x[0][l], x[1][l], x[2][l]}});
                    for (std::size_t k = 0; k < 3; ++k) {
                        shift[k][l] += above * q.frame.normal[k];
                        blended[k][l] += w * n[k];
                    }
                }
            }
            for (std::size_t l = 0; l < block.count; ++l) {
                const std::size_t p = block.first + l;
                const Vec3 n{{blended[0][l], blended[1][l], blended[2][l]}};
                const double length = norm(n);
                if (all[l] == 0.0 || length == 0.0) continue;
                fine.position[p] -= (1.0 / all[l]) * Vec3{{shift[0][l], shift[1][l], shift[2][l]}};
                fine.normal[p] = n / length;
            }
        }
    });
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
