#include "lamella/solvers/melp/redistribution.h"

#include "lamella/linalg/conjugate_gradient.h"
#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/operators.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::melp {
namespace {

constexpr double kFarthest = 0.1, kFarthestInFoams = 0.3;  // spacings
constexpr double kReach = 200.0;                           // spacing^2: waves longer than 14 spacings go within a pass
constexpr double kShort = 0.3;                             // spacing^2

/// Density over the region's mean, minus one.
std::vector<double> excess(const Geometry& g, const CoarseParticles& coarse, std::size_t regions) {
    const std::vector<double> sum =
        sum_over_regions(coarse.region, regions, [&](std::size_t i) { return 1.0 / g.area[i]; });
    const std::vector<double> particles = sum_over_regions(coarse.region, regions, [](std::size_t) { return 1.0; });
    std::vector<double> result(g.size());
    for_each_particle(g.size(), [&](std::size_t i) {
        const auto r = static_cast<std::size_t>(coarse.region[i]);
        result[i] = particles[r] / (sum[r] * g.area[i]) - 1.0;
    });
    return result;
}

std::vector<double> smoothed(const Geometry& g, const std::vector<double>& q, double reach) {
    const Neighbors& same = g.neighbors.same;
    const std::size_t count = g.size();
    std::vector<double> right(count), scale(count), diagonal(count);
    RawVector<float> pair(same.index.size());
    for_each_particle(count, [&](std::size_t i) {
        double sum = 0.0;
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
            pair[k] = static_cast<float>(g.area[i] * g.area[same.index[k]] * same.laplacian[k]);
            sum += double{pair[k]};
        }
        diagonal[i] = g.area[i] + reach * sum;
        scale[i] = 1.0 / diagonal[i];
        right[i] = g.area[i] * q[i];
    });
    const auto apply = [&](const std::vector<double>& x, std::vector<double>& y) {
        y.resize(count);
        for_each_particle(
            count, [&](std::size_t i) { y[i] = diagonal[i] * x[i] - reach * sum_of_products(same, pair, x, i); });
    };
    std::vector<double> phi(count, 0.0);
    constexpr double kTolerance = 1e-2;
    constexpr int kMostIterations = 200;
    linalg::conjugate_gradient(apply, scale, right, phi, kTolerance, kMostIterations);
    return phi;
}

/// How far long waves may shift the particles of each region. [m]
std::vector<double> farthest_shifts(const Geometry& g, std::size_t regions, double spacing) {
    std::vector<double> farthest(regions, kFarthest * spacing);
    for (const RegionPair& pair : g.neighbors.touching)
        for (const std::int32_t region : pair) farthest[static_cast<std::size_t>(region)] = kFarthestInFoams * spacing;
    return farthest;
}

double shortened(double length, double most) { return length > most ? most / length : 1.0; }

}  // namespace

std::vector<Vec3> evening_shift(const Geometry& g, const CoarseParticles& coarse, std::size_t regions, double spacing) {
    const double reach = kReach * spacing * spacing;
    std::vector<Vec3> shift = gradient(g, coarse.position, smoothed(g, excess(g, coarse, regions), reach));
    // Of each film on its own: one crowded spot would hold back all of a foam.
    std::vector<double> longest(regions, 0.0);
    for (std::size_t i = 0; i < shift.size(); ++i) {
        shift[i] *= -reach;
        double& most = longest[static_cast<std::size_t>(coarse.region[i])];
        most = std::max(most, norm(shift[i]));
    }
    const std::vector<double> farthest = farthest_shifts(g, regions, spacing);
    const std::vector<Vec3> uneven = unevenness(g, coarse.position);
    for_each_particle(shift.size(), [&](std::size_t i) {
        Vec3 away = (-kShort * spacing * spacing) * uneven[i];
        away -= dot(away, g.normal[i]) * g.normal[i];
        const auto region = static_cast<std::size_t>(coarse.region[i]);
        shift[i] =
            shortened(longest[region], farthest[region]) * shift[i] + shortened(norm(away), kFarthest * spacing) * away;
    });
    return shift;
}

double density_spread(const Geometry& g, const CoarseParticles& coarse, std::size_t regions) {
    const std::vector<double> e = excess(g, coarse, regions);
    std::vector<double> low(regions, std::numeric_limits<double>::infinity()), high(regions, -1.0);
    for (std::size_t i = 0; i < e.size(); ++i) {
        const auto r = static_cast<std::size_t>(coarse.region[i]);
        low[r] = std::min(low[r], e[i]);
        high[r] = std::max(high[r], e[i]);
    }
    double worst = 0.0;
    for (std::size_t r = 0; r < regions; ++r) worst = std::max(worst, high[r] - low[r]);
    return worst;
}

Vec3 along_patch(const Patch& patch, const Vec3& shift) {
    const double u = dot(patch.frame.e1, shift), v = dot(patch.frame.e2, shift);
    return u * patch.frame.e1 + v * patch.frame.e2 + (patch.height(u, v) - patch.c[0]) * patch.frame.normal;
}

}  // namespace lamella::melp
