// Two bubbles that have just touched settle into the standard double bubble. [method sheet 14: V2, V4]

#include <gtest/gtest.h>

#include "caps.h"
#include <cstdio>
#include <utility>

namespace lamella::melp {
namespace {

TEST(DoubleBubble, SettlesFromFirstContact) {
    auto solver = settling_cluster({{{{-0.0502, 0.0, 0.0}}, 0.05}, {{{0.0502, 0.0, 0.0}}, 0.05}}, 0.003545);
    for (const double time : {0.05, 0.1, 0.15}) {
        while (solver->time() < time) solver->advance(time);
        const Cap a = cap_of(*solver, 0), b = cap_of(*solver, 1);
        // Two equal caps and the disk between them: it meets them at 90 degrees + asin(half the distance / radius).
        const double half = 0.5 * norm(b.center - a.center), radius = 0.5 * (a.radius + b.radius);
        const double angle = 90.0 + 180.0 / std::numbers::pi * std::asin(half / radius);
        const double area = std::numbers::pi * (4.0 * radius * (radius + half) + (radius * radius - half * half));
        const double volume = 1.0 / 3.0 * std::numbers::pi * (radius + half) * (radius + half) * (2.0 * radius - half);
        const double ideal = 27.0 * std::numbers::pi * std::pow(volume / (9.0 * std::numbers::pi), 2.0 / 3.0);
        std::printf("t %.2f angle %.2f area %+.4f of 0.059372, shape %+.5f, speed %.3f, spread %.2f\n", time, angle,
                    area / 0.0593723807167931 - 1.0, area / ideal - 1.0, scalar(*solver, "max_velocity"),
                    scalar(*solver, "density_spread"));
        std::fflush(stdout);
        EXPECT_NEAR(angle, 120.0, 1.2);
        EXPECT_NEAR(area / 0.0593723807167931, 1.0, 0.005);
        EXPECT_NEAR(area / ideal, 1.0, 1e-3);
    }
}

/// Three of 1257 coarse particles each: all three pairs of caps meet at 120 degrees, and no fold tears. It did after
/// 50 ms.
TEST(TripleBubble, SettlesFromFirstContact) {
    auto solver = settling_cluster(
        {{{{-0.0502, 0.0, 0.0}}, 0.05}, {{{0.0502, 0.0, 0.0}}, 0.05}, {{{0.0, 0.08695, 0.0}}, 0.05}}, 0.005);
    for (const double time : {0.03, 0.08}) {
        while (solver->time() < time) solver->advance(time);
        for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
            const double angle = angle_between(cap_of(*solver, a), cap_of(*solver, b));
            std::printf("t %.2f caps %d and %d: %.2f degrees, spread %.2f\n", time, a, b, angle,
                        scalar(*solver, "density_spread"));
            EXPECT_NEAR(angle, 120.0, 1.2);
        }
        EXPECT_LT(scalar(*solver, "density_spread"), 0.25);
    }
}

/// Four of 1257 in a tetrahedron: six pairs of caps.
TEST(QuadrupleBubble, SettlesFromFirstContact) {
    constexpr double kArm = 0.0355;
    auto solver = settling_cluster({{{{kArm, kArm, kArm}}, 0.05},
                                    {{{kArm, -kArm, -kArm}}, 0.05},
                                    {{{-kArm, kArm, -kArm}}, 0.05},
                                    {{{-kArm, -kArm, kArm}}, 0.05}},
                                   0.005);
    while (solver->time() < 0.03) solver->advance(0.03);
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b)
            EXPECT_NEAR(angle_between(cap_of(*solver, a), cap_of(*solver, b)), 120.0, 2.4) << a << " and " << b;
    EXPECT_LT(scalar(*solver, "density_spread"), 0.25);
    EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0);
}

/// The partition's curvature is the difference of those of the caps. [method sheet 14, V3, of table 5.2 in Deng22] The
/// table's radii are taken as those of the caps, and as those of the bubbles before they touch.
TEST(UnequalBubbles, HaveThePartitionThatTheirPressuresAskFor) {
    struct Case {
        double large, small, curvature;
    };
    for (const Case& c : {Case{0.04926, 0.02616, 13.333}, Case{0.05, 0.03, 9.97}}) {
        auto solver = settling_cluster(
            {{{{-1.004 * c.large, 0.0, 0.0}}, c.large}, {{{1.004 * c.small, 0.0, 0.0}}, c.small}}, 0.0035);
        while (solver->time() < 0.04) solver->advance(0.04);
        const Cap large = cap_of(*solver, 0), small = cap_of(*solver, 1);
        const double curvature = partition_curvature(*solver, 0, 1);
        std::printf("curvature %.3f of %.3f, of the caps %.3f; angle %.2f\n", curvature, c.curvature,
                    1.0 / small.radius - 1.0 / large.radius, angle_between(large, small));
        std::fflush(stdout);
        EXPECT_NEAR(curvature / c.curvature, 1.0, 0.015);
        EXPECT_NEAR(angle_between(large, small), 120.0, 1.2);
        for (const auto& [cap, r] : {std::pair{large, 0}, {small, 1}})
            EXPECT_NEAR(solver->gas()[r].balanced * cap.radius / (4.0 * 0.0725), 1.0, 0.01);
    }
}

}  // namespace
}  // namespace lamella::melp
