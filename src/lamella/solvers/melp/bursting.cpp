#include "lamella/solvers/melp/bursting.h"

#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/operators.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::melp {
namespace {

bool has_burst(const CoarseParticles& coarse, std::span<const std::uint8_t> burst, std::size_t i) {
    return burst[static_cast<std::size_t>(coarse.region[i])] != 0;
}

}  // namespace

std::vector<double> edge_strength(const Geometry& g, const CoarseParticles& coarse) {
    const std::vector<Vec3> uneven = unevenness(g, coarse.position);
    std::vector<double> strength(uneven.size());
    for (std::size_t i = 0; i < strength.size(); ++i)
        strength[i] = norm(uneven[i]) * g.neighbors.same.kernel.support_radius;
    return strength;
}

std::vector<std::uint8_t> edge_zone(const Geometry& g,
                                    const CoarseParticles& coarse,
                                    std::span<const double> strength,
                                    std::span<const std::uint8_t> burst) {
    constexpr double kEdge = 0.25;
    const Neighbors& same = g.neighbors.same;
    std::vector<std::uint8_t> zone(coarse.size(), 0);
    for (std::size_t i = 0; i < zone.size(); ++i) {
        if (!has_burst(coarse, burst, i)) continue;
        bool near = strength[i] > kEdge;
        for (std::size_t k = same.begin(i); k < same.end(i) && !near; ++k) near = strength[same.index[k]] > kEdge;
        zone[i] = near ? 1 : 0;
    }
    return zone;
}

std::vector<Vec3> edge_pull(const Geometry& g,
                            const CoarseParticles& coarse,
                            std::span<const double> tension,
                            std::span<const std::uint8_t> zone) {
    const Neighbors& same = g.neighbors.same;
    const std::vector<Vec3>& x = coarse.position;
    std::vector<Vec3> pull(coarse.size());
    for_each_particle(coarse.size(), [&](std::size_t i) {
        if (zone[i] == 0) return;
        Vec3 sum;
        const auto add = [&](std::size_t j, double laplacian, const Vec3& place) {
            sum += ((tension[i] + tension[j]) * (g.area[i] * g.area[j]) * laplacian) * (place - x[i]);
        };
        for (std::size_t k = same.begin(i); k < same.end(i); ++k)
            add(same.index[k], same.laplacian[k], x[same.index[k]]);
        for (std::size_t k = g.images.begin(i); k < g.images.end(i); ++k)
            add(g.images.index[k], g.images.laplacian[k], g.images.place[k]);
        pull[i] = sum - dot(sum, g.normal[i]) * g.normal[i];
    });
    return pull;
}

std::vector<Vec3> shared_acceleration(const Geometry& g, std::span<const Vec3> force, std::span<const double> mass) {
    const Neighbors& same = g.neighbors.same;
    const double own = same.kernel.value(0.0);
    std::vector<Vec3> per_mass(g.size());
    for_each_particle(g.size(), [&](std::size_t j) {
        double around = own * mass[j];
        for (std::size_t k = same.begin(j); k < same.end(j); ++k) around += same.weight[k] * mass[same.index[k]];
        per_mass[j] = force[j] / around;
    });
    std::vector<Vec3> acceleration(g.size());
    for_each_particle(g.size(), [&](std::size_t i) {
        Vec3 sum = own * per_mass[i];
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) sum += same.weight[k] * per_mass[same.index[k]];
        acceleration[i] = sum - dot(sum, g.normal[i]) * g.normal[i];
    });
    return acceleration;
}

std::vector<std::uint8_t> crowded(const Geometry& g,
                                  const CoarseParticles& coarse,
                                  std::span<const double> strength,
                                  std::span<const std::uint8_t> burst,
                                  double spacing) {
    constexpr double kNearest = 0.5;  // spacings
    const double nearest = kNearest * spacing;
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < coarse.size(); ++i)
        if (has_burst(coarse, burst, i)) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return strength[a] > strength[b]; });
    std::vector<std::uint8_t> stays(coarse.size(), 0), marked(coarse.size(), 0);
    const Neighbors& same = g.neighbors.same;
    for (const std::size_t i : order) {
        bool free = true;
        for (std::size_t k = same.begin(i); k < same.end(i) && free; ++k) {
            const std::size_t j = same.index[k];
            free = stays[j] == 0 || squared_norm(coarse.position[i] - coarse.position[j]) >= nearest * nearest;
        }
        (free ? stays : marked)[i] = 1;
    }
    return marked;
}

std::vector<std::uint8_t> open_hole(const CoarseParticles& coarse, FineParticles& fine, std::size_t at, double radius) {
    const Vec3 center = coarse.position[at], normal = coarse.frame_normal[at];
    const std::int32_t region = coarse.region[at];
    std::vector<std::uint8_t> marked(coarse.size(), 0);
    for (std::size_t i = 0; i < coarse.size(); ++i)
        if (coarse.region[i] == region && squared_norm(coarse.position[i] - center) < radius * radius) marked[i] = 1;
    for (std::size_t p = 0; p < fine.size(); ++p) {
        Vec3 d = fine.position[p] - center;
        if (fine.region[p] != region || squared_norm(d) >= radius * radius) continue;
        d -= dot(d, normal) * normal;
        const double length = norm(d);
        if (length > 0.0) fine.position[p] += (radius / length - 1.0) * d;
    }
    return marked;
}

}  // namespace lamella::melp
