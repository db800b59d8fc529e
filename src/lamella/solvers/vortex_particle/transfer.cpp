#include "lamella/solvers/vortex_particle/transfer.h"

#include "lamella/core/parallel.h"
#include "lamella/core/simd.h"

#include <algorithm>
#include <array>

namespace lamella::vortex_particle {
namespace {

constexpr std::size_t kBlock = 512;  // vertices or triangles that one task handles

double kernel(double squared_distance, double inverse_square) {
    const double q = std::max(0.0, 1.0 - squared_distance * inverse_square);
    return q * q * q;
}

/// Whether a film that leaves in another direction is another sheet that only comes close [method sheet 5.1].
bool faces_away(const Vec3& a, const Vec3& b) { return dot(a, b) < 0.5; }

}  // namespace

Transfer::Transfer(const Surface& s, Reach reach, double radius) : reach_(reach), radius_(radius) {
    if (reach_ == Reach::kHat) return;
    // Around each vertex, over neighbors, as long as some point of a triangle may be within the radius.
    std::vector<std::uint32_t> seen(s.triangles(), 0), queue;
    std::vector<std::vector<std::uint32_t>> vertices_of(s.triangles());
    triangle_start_.assign(1, 0);
    for (std::uint32_t v = 0; v < s.vertices(); ++v) {
        queue.clear();
        const auto add = [&](std::int32_t t) {
            if (t == kNoNeighbor || seen[static_cast<std::size_t>(t)] == v + 1) return;
            seen[static_cast<std::size_t>(t)] = v + 1;
            const auto n = static_cast<std::size_t>(t);
            double nearest = norm(s.position[s.corner[n][0]] - s.position[v]), longest = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
                nearest = std::min(nearest, norm(s.position[s.corner[n][k]] - s.position[v]));
                longest = std::max(longest, norm(s.edge(n, k)));
            }
            if (nearest < radius_ + 0.5 * longest && !faces_away(s.normal[n], s.vertex_normal[v]))
                queue.push_back(static_cast<std::uint32_t>(t));
        };
        for (const Incidence& at : s.around(v)) add(static_cast<std::int32_t>(at.triangle));
        for (std::size_t k = 0; k < queue.size(); ++k)
            for (const std::int32_t t : s.neighbor[queue[k]]) add(t);
        std::sort(queue.begin(), queue.end());
        triangle_.insert(triangle_.end(), queue.begin(), queue.end());
        triangle_start_.push_back(triangle_.size());
        for (const std::uint32_t t : queue) vertices_of[t].push_back(v);
    }
    vertex_start_.assign(1, 0);
    for (const auto& list : vertices_of) {
        vertex_.insert(vertex_.end(), list.begin(), list.end());
        vertex_start_.push_back(vertex_.size());
    }
}

template <class Use>
void Transfer::each_vertex(const Surface& s, const Particles& particles, std::size_t p, Use&& use) const {
    const std::uint32_t t = particles.triangle[p];
    if (reach_ == Reach::kHat) {
        for (std::size_t k = 0; k < 3; ++k) use(s.corner[t][k], particles.place[p][k]);
        return;
    }
    const Vec3 x = s.point(t, particles.place[p]);
    const double inverse = 1.0 / (radius_ * radius_);
    const std::span list = std::span(vertex_).subspan(vertex_start_[t], vertex_start_[t + 1] - vertex_start_[t]);
    double total = 0.0;
    for (const std::uint32_t v : list) total += kernel(squared_norm(s.position[v] - x), inverse);
    for (const std::uint32_t v : list) {
        const double w = kernel(squared_norm(s.position[v] - x), inverse);
        if (w > 0.0) use(v, w / total);
    }
}

template <std::size_t Columns>
void Transfer::sum_to_vertices(const Surface& s, const Particles& particles, const Bins& bins,
                               const std::array<std::span<const double>, Columns>& value,
                               const std::array<std::span<double>, Columns>& sum) const {
    if (reach_ == Reach::kHat) {
        // Sums of each triangle at its corners, then of each vertex over its triangles: no two tasks write one number.
        std::vector<std::array<std::array<double, Columns>, 3>> corner(s.triangles());
        parallel_blocks(s.triangles(), kBlock, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                corner[t] = {};
                for (std::size_t p = bins[t]; p < bins[t + 1]; ++p)
                    for (std::size_t k = 0; k < 3; ++k)
                        for (std::size_t c = 0; c < Columns; ++c) corner[t][k][c] += particles.place[p][k] * value[c][p];
            }
        });
        parallel_blocks(s.vertices(), kBlock, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                std::array<double, Columns> total{};
                for (const auto& [t, k] : s.around(v))
                    for (std::size_t c = 0; c < Columns; ++c) total[c] += corner[t][k][c];
                for (std::size_t c = 0; c < Columns; ++c) sum[c][v] = total[c];
            }
        });
        return;
    }
    // Positions in columns, and what each particle's weights are to be divided by.
    const double inverse = 1.0 / (radius_ * radius_);
    std::vector<double> x(particles.size()), y(particles.size()), z(particles.size()), share(particles.size());
    parallel_blocks(s.triangles(), kBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t)
            for (std::size_t p = bins[t]; p < bins[t + 1]; ++p) {
                const Vec3 at = s.point(t, particles.place[p]);
                x[p] = at[0], y[p] = at[1], z[p] = at[2];
                double total = 0.0;
                for (std::size_t i = vertex_start_[t]; i < vertex_start_[t + 1]; ++i)
                    total += kernel(squared_norm(s.position[vertex_[i]] - at), inverse);
                share[p] = 1.0 / total;
            }
    });
    parallel_blocks(s.vertices(), kBlock / 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const Vec3 at = s.position[v];
            std::array<Simd, Columns> lanes{};
            std::array<double, Columns> rest{};
            for (std::size_t i = triangle_start_[v]; i < triangle_start_[v + 1]; ++i) {
                const std::size_t t = triangle_[i];
                std::size_t p = bins[t];
                for (; p + kLanes <= bins[t + 1]; p += kLanes) {
                    const Simd dx = load_lanes(&x[p]) - at[0], dy = load_lanes(&y[p]) - at[1], dz = load_lanes(&z[p]) - at[2];
                    const Simd q = larger(Simd(1.0) - (dx * dx + dy * dy + dz * dz) * inverse, Simd(0.0));
                    const Simd w = q * q * q * load_lanes(&share[p]);
                    for (std::size_t c = 0; c < Columns; ++c) lanes[c] += w * load_lanes(&value[c][p]);
                }
                for (; p < bins[t + 1]; ++p) {
                    const double w = kernel(squared_norm(Vec3{{x[p], y[p], z[p]}} - at), inverse) * share[p];
                    for (std::size_t c = 0; c < Columns; ++c) rest[c] += w * value[c][p];
                }
            }
            for (std::size_t c = 0; c < Columns; ++c) {
                for (std::size_t lane = 0; lane < kLanes; ++lane) rest[c] += lanes[c][lane];
                sum[c][v] = rest[c];
            }
        }
    });
}

Deposit Transfer::deposit(const Surface& s, const Particles& particles, const Bins& bins) const {
    Deposit sum;
    for (auto* column : {&sum.circulation, &sum.volume, &sum.amount, &sum.area}) column->resize(s.vertices());
    sum_to_vertices<4>(s, particles, bins, {particles.circulation, particles.volume, particles.amount, particles.area},
                       {sum.circulation, sum.volume, sum.amount, sum.area});
    return sum;
}

std::vector<double> Transfer::deposit(const Surface& s, const Particles& particles, const Bins& bins,
                                      std::span<const double> value) const {
    std::vector<double> sum(s.vertices());
    sum_to_vertices<1>(s, particles, bins, {value}, {sum});
    return sum;
}

std::vector<double> Transfer::gather(const Surface& s, const Particles& particles, std::span<const double> value) const {
    std::vector<double> at(particles.size());
    parallel_for(particles.size(), [&](std::size_t p) {
        double sum = 0.0;
        each_vertex(s, particles, p, [&](std::uint32_t v, double w) { sum += w * value[v]; });
        at[p] = sum;
    });
    return at;
}

std::vector<Vec3> triangle_velocity(const Surface& s, const Particles& particles, const Bins& bins,
                                    std::span<const Vec3> before) {
    std::vector<Vec3> mean(before.begin(), before.end());
    parallel_blocks(s.triangles(), kBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            if (bins[t] == bins[t + 1]) continue;
            Vec3 sum;
            double area = 0.0;
            for (std::size_t p = bins[t]; p < bins[t + 1]; ++p) {
                sum += particles.area[p] * particles.velocity[p];
                area += particles.area[p];
            }
            mean[t] = sum / area;
            mean[t] -= dot(mean[t], s.normal[t]) * s.normal[t];
        }
    });
    return mean;
}

}  // namespace lamella::vortex_particle
