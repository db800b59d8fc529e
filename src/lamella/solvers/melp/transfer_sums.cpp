// What fine and coarse particles give each other, by the weights that are there.

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/transfer.h"
#include "lamella/solvers/melp/transfer_lanes.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {

/// What pictures have received is their particles', momentum turned back.
void Transfer::hand_in_pictures(Gathered& gathered) const {
    const std::size_t count = gathered.liquid_volume.size() - pictures_.size();
    for (std::size_t m = 0; m < pictures_.size(); ++m) {
        const auto& [source, mirror] = pictures_[m];
        const double volume = gathered.liquid_volume[count + m];
        gathered.liquid_volume[source] += volume;
        gathered.surfactant[source] += gathered.surfactant[count + m];
        gathered.seen_volume[source] += gathered.seen_volume[count + m];
        gathered.heat[source] += gathered.heat[count + m];
        const Vec3 w = gathered.momentum[count + m] - volume * mirror.drift;
        gathered.momentum[source] += w[0] * mirror.map[0] + w[1] * mirror.map[1] + w[2] * mirror.map[2];
    }
    gathered.liquid_volume.resize(count);
    gathered.surfactant.resize(count);
    gathered.seen_volume.resize(count);
    gathered.heat.resize(count);
    gathered.momentum.resize(count);
}

Gathered Transfer::to_coarse(const CoarseParticles& coarse, const FineParticles& fine) const {
    // What a fine particle gives, all times its weight: volume, surfactant, seen volume, momentum at the chunk's origin
    // and its gradient (9), and heat: two rows of eight.
    constexpr std::size_t kGiven = 16, kKept = 7;
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
                given[l][15] = v * fine.temperature[p];
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
            to[6] = sum[k][15];
        }
    });

    Gathered gathered;
    gathered.liquid_volume.resize(place.size());
    gathered.surfactant.resize(place.size());
    gathered.seen_volume.resize(place.size());
    gathered.momentum.resize(place.size());
    gathered.heat.resize(place.size());
    parallel_for(place.size(), [&](std::size_t e) {
        std::array<double, kKept> sum{};
        for (std::size_t k = places_start_[e]; k < places_start_[e + 1]; ++k)
            for (std::size_t q = 0; q < kKept; ++q) sum[q] += received[places_[k][0]][kKept * places_[k][1] + q];
        gathered.liquid_volume[e] = sum[0];
        gathered.surfactant[e] = sum[1];
        gathered.seen_volume[e] = sum[2];
        gathered.momentum[e] = {{sum[3], sum[4], sum[5]}};
        gathered.heat[e] = sum[6];
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
    constexpr double kMostDetail = 30.0;  // where flows are rough, thickness would add up to meters, or below nothing
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
            load_lanes<kLanes>(fine.position, block.first, block.count, x);
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
                const double film = mean(21), followed = fine.thickness[p] + rate * (film - mean(22));
                fine.thickness[p] = std::clamp(followed, film / kMostDetail, kMostDetail * film);
            }
        }
    });
}

void Transfer::grow(const Growth& growth, FineParticles& fine) const {
    constexpr std::size_t kSums = 6;
    const std::size_t count = growth.liquid_volume.size();
    parallel_blocks(chunks_.size(), 1, [&](std::size_t c, std::size_t) {
        const Chunk& chunk = chunks_[c];
        for (const Block& block : chunk.block) {
            std::array<Lanes, kSums> sum{};
            for (std::size_t row = 0; row < block.rows; ++row) {
                const float* weight = &chunk.weight[(block.weights + row) * kLanes];
                std::uint32_t e = chunk.coarse[chunk.candidate[block.candidates + row]];
                const Picture* picture = e < count ? nullptr : &pictures_[e - count];
                if (picture != nullptr) e = picture->source;
                const Vec3 u = picture == nullptr ? growth.momentum[e] : picture->mirror.map * growth.momentum[e];
                const std::array<double, kSums> gain{growth.liquid_volume[e], growth.surfactant[e], u[0], u[1], u[2],
                                                     growth.heat[e]};
                for (std::size_t q = 0; q < kSums; ++q)
                    for (std::size_t l = 0; l < kLanes; ++l) sum[q][l] += static_cast<double>(weight[l]) * gain[q];
            }
            for (std::size_t l = 0; l < block.count; ++l) {
                const std::size_t p = block.first + l;
                const double scale = inverse_sum_[p], factor = 1.0 + scale * sum[0][l];
                const Vec3 gained{{sum[2][l], sum[3][l], sum[4][l]}};
                fine.liquid_volume[p] *= factor;
                fine.thickness[p] *= factor;
                fine.surfactant[p] *= 1.0 + scale * sum[1][l];
                fine.velocity[p] = (fine.velocity[p] + scale * gained) / factor;
                fine.temperature[p] = (fine.temperature[p] + scale * sum[5][l]) / factor;
            }
        }
    });
}

std::vector<double> Transfer::at_fine(std::span<const double> values) const {
    std::vector<double> result(inverse_sum_.size(), 0.0);
    parallel_blocks(chunks_.size(), 1, [&](std::size_t c, std::size_t) {
        const Chunk& chunk = chunks_[c];
        for (const Block& block : chunk.block) {
            Lanes sum{};
            for (std::size_t row = 0; row < block.rows; ++row) {
                const float* weight = &chunk.weight[(block.weights + row) * kLanes];
                std::size_t e = chunk.coarse[chunk.candidate[block.candidates + row]];
                if (e >= values.size()) e = pictures_[e - values.size()].source;
                for (std::size_t l = 0; l < kLanes; ++l) sum[l] += static_cast<double>(weight[l]) * values[e];
            }
            for (std::size_t l = 0; l < block.count; ++l)
                result[block.first + l] = inverse_sum_[block.first + l] * sum[l];
        }
    });
    return result;
}

void Transfer::project(std::span<const Patch> patch, std::span<const Vec3> normal, FineParticles& fine) const {
    parallel_blocks(chunks_.size(), 1, [&](std::size_t c, std::size_t) {
        const Chunk& chunk = chunks_[c];
        std::array<Lanes, 3> x;
        for (const Block& block : chunk.block) {
            load_lanes<kLanes>(fine.position, block.first, block.count, x);
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

}  // namespace lamella::melp
