#include "lamella/solvers/melp/pair_forces.h"

#include "lamella/solvers/melp/loops.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {

Cohesion cohesion(double gamma, double beta) {
    // Beyond 1 the attraction falls as fast as this: with gamma^-2 borders of three bubbles crumpled, without a fall
    // single particles were drawn into the point where three bubbles and the air meet.
    constexpr double kPower = 6.0;
    const double shared = std::min(gamma, 1.0), excess = std::max(gamma, 1.0);
    const double slope = gamma < 1.0 ? 1.0 + beta * (1.0 - 2.0 * gamma) : (1.0 - beta) * std::pow(gamma, -kPower);
    const double f = shared + beta * shared * (1.0 - shared) +
                     (1.0 - beta) * (1.0 - std::pow(excess, 1.0 - kPower)) / (kPower - 1.0);
    return {2.0 - f - gamma * slope, slope};
}

namespace {

constexpr double kStiff = 36.0;  // of these springs and of walls, tension / support radius^2

Spring spring_between(const NormalProblem& p, std::size_t i, std::size_t k) {
    constexpr double kJoined = 0.5 / 3.0, kApart = -1.0 / 3.0;  // support radii, which are 3 spacings by default
    const Neighbors& other = p.geometry.neighbors.other;
    const std::size_t j = other.index[k];
    const double cosine = dot(p.geometry.normal[i], p.geometry.normal[j]);
    if (cosine > 0.0) return {};  // films that do not face each other
    const Vec3 between = (p.geometry.normal[i] - p.geometry.normal[j]) / std::sqrt(2.0 - 2.0 * cosine);
    const double reach = other.kernel.support_radius;
    const double share = p.joined.empty() ? 1.0 : p.joined[k];
    const double free = reach * (share * kJoined + (1.0 - share) * kApart);
    const double depth = dot(p.coarse.position[i] - p.coarse.position[j], between) - free;
    if (depth <= 0.0) return {};
    const double tension = p.interface_tension[i] + p.interface_tension[j];
    const double along = std::sqrt(0.5 * (1.0 - cosine));  // between . n_i
    const double pressure = kStiff * tension / (reach * reach) * other.weight[k];
    const double area = p.geometry.area[i] * p.geometry.area[j];
    return {area * pressure * along * along, area * pressure * along * depth};
}

}  // namespace

Spring spring_of_walls(const NormalProblem& p, std::size_t i) {
    const double reach = p.geometry.neighbors.same.kernel.support_radius;
    Spring all{};
    for (const film::Wall& wall : p.walls) {
        const double depth = dot(wall.point - p.coarse.position[i], wall.normal);
        if (depth <= 0.0) continue;
        const double along = dot(wall.normal, p.geometry.normal[i]);
        const double stiffness = p.geometry.area[i] * kStiff * 2.0 * p.interface_tension[i] / (reach * reach);
        all.stiffness += stiffness * along * along;
        all.force += stiffness * along * depth;
    }
    return all;
}

Pairs pair_strengths(const NormalProblem& p) {
    const Neighbors& same = p.geometry.neighbors.same;
    const Neighbors& other = p.geometry.neighbors.other;
    const Images& images = p.geometry.images;
    const std::vector<double>& a = p.geometry.area;
    Pairs pairs;
    pairs.gamma.resize(a.size());
    pairs.own.resize(a.size());
    pairs.same.resize(same.index.size());
    pairs.other.resize(other.index.size());
    pairs.image.resize(images.index.size());
    pairs.push.resize(other.index.size());
    std::vector<double> toward(a.size());  // sigma f'
    for_each_particle(a.size(), [&](std::size_t i) {
        double gamma = 0.0;
        for (std::size_t k = other.begin(i); k < other.end(i); ++k)
            gamma += (p.joined.empty() ? 1.0 : p.joined[k]) * a[other.index[k]] * other.weight[k];
        pairs.gamma[i] = gamma;
        const Cohesion c = cohesion(gamma, p.junction_correction);
        pairs.own[i] = p.interface_tension[i] * c.own;
        toward[i] = p.interface_tension[i] * c.other;
    });
    for_each_particle(a.size(), [&](std::size_t i) {
        const auto strength = [&](const auto& list, std::size_t k, const std::vector<double>& tension) {
            const std::size_t j = list.index[k];
            return 0.5 * (tension[i] + tension[j]) * (a[i] * a[j]) * list.laplacian[k];
        };
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) pairs.same[k] = strength(same, k, pairs.own);
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
            pairs.other[k] = (p.joined.empty() ? 1.0 : p.joined[k]) * strength(other, k, toward);
            pairs.push[k] = spring_between(p, i, k);
        }
        for (std::size_t k = images.begin(i); k < images.end(i); ++k) pairs.image[k] = strength(images, k, pairs.own);
    });
    return pairs;
}

std::vector<double> pair_forces(const NormalProblem& p, const Pairs& pairs) {
    const Geometry& g = p.geometry;
    const std::vector<Vec3>& x = p.coarse.position;
    std::vector<double> force(g.size());
    for_each_particle(g.size(), [&](std::size_t i) {
        Vec3 pull;
        double push = 0.0;
        const Neighbors& same = g.neighbors.same;
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) pull += pairs.same[k] * (x[same.index[k]] - x[i]);
        const Neighbors& other = g.neighbors.other;
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
            pull += pairs.other[k] * (x[other.index[k]] - x[i]);
            push -= pairs.push[k].force;
        }
        const Images& images = g.images;
        for (std::size_t k = images.begin(i); k < images.end(i); ++k) pull += pairs.image[k] * (images.place[k] - x[i]);
        force[i] = dot(pull, g.normal[i]) + push;
    });
    return force;
}

}  // namespace lamella::melp
