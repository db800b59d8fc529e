// Shifts along the film that keep coarse particles evenly spread.

#include "lamella/solvers/melp/redistribution.h"

#include "lamella/solvers/melp/start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::melp {
namespace {

constexpr std::size_t kCount = 600;
const double kSpacing = std::sqrt(4.0 * std::numbers::pi / kCount);

/// On the unit sphere, drawn toward a pole: at most four times as dense there for `pull` = 0.5.
CoarseParticles drawn(double pull) {
    CoarseParticles coarse;
    for (const Vec3& x : fibonacci_sphere(kCount)) {
        const double angle = std::acos(x[2]), drawn = angle * (1.0 - pull * (1.0 - angle / std::numbers::pi));
        const double flat = std::hypot(x[0], x[1]), s = std::sin(drawn);
        coarse.position.push_back({{s * x[0] / flat, s * x[1] / flat, std::cos(drawn)}});
    }
    coarse.frame_normal = coarse.position;
    coarse.velocity.resize(kCount);
    coarse.region.resize(kCount, 0);
    return coarse;
}

Geometry shape(const CoarseParticles& coarse) { return geometry_of(coarse, 3.0 * kSpacing); }

/// Of the first 600 particles, of one or two spheres.
double longest_shift(const CoarseParticles& coarse) {
    const std::vector<Vec3> shift = evening_shift(shape(coarse), coarse, coarse.size() / kCount, kSpacing);
    double longest = 0.0;
    for (std::size_t i = 0; i < kCount; ++i) longest = std::max(longest, norm(shift[i]));
    return longest;
}

/// With another sphere beside it, a spacing off.
CoarseParticles touched(CoarseParticles coarse) {
    const CoarseParticles other = drawn(0.0);
    for (std::size_t i = 0; i < kCount; ++i) {
        coarse.position.push_back(other.position[i] + Vec3{{2.0 + kSpacing, 0.0, 0.0}});
        coarse.frame_normal.push_back(other.frame_normal[i]);
        coarse.velocity.push_back({});
        coarse.region.push_back(1);
    }
    return coarse;
}

TEST(Redistribution, MovesCrowdsBoundedlyAndFasterInFoams) {
    EXPECT_LT(longest_shift(drawn(0.0)), 0.05 * kSpacing);
    EXPECT_GT(longest_shift(drawn(0.5)), 0.08 * kSpacing);
    EXPECT_LT(longest_shift(drawn(0.5)), 0.21 * kSpacing);
    EXPECT_GT(longest_shift(touched(drawn(0.5))), 0.25 * kSpacing);
    EXPECT_LT(longest_shift(touched(drawn(0.5))), 0.41 * kSpacing);
}

TEST(Redistribution, EvensOutACrowdInSixtyPasses) {
    CoarseParticles coarse = drawn(0.5);
    const double before = density_spread(shape(coarse), coarse, 1);
    EXPECT_GT(before, 2.0);
    for (int pass = 0; pass < 60; ++pass) {
        const Geometry g = shape(coarse);
        const std::vector<Vec3> shift = evening_shift(g, coarse, 1, kSpacing);
        for (std::size_t i = 0; i < kCount; ++i) coarse.position[i] += along_patch(g.patch[i], shift[i]);
        coarse.frame_normal = g.normal;
    }
    EXPECT_LT(density_spread(shape(coarse), coarse, 1), 0.1 * before);
}

}  // namespace
}  // namespace lamella::melp
