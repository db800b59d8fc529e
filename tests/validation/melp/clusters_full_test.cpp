// Bubbles that have just touched settle into the clusters that theory knows. [method sheet 14: V2, V3, V4]

#include "lamella/solvers/melp/foam.h"

#include <gtest/gtest.h>

#include "caps.h"
#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace lamella::melp {
namespace {

TEST(DoubleBubble, SettlesFromFirstContact) {
    auto solver = settling_cluster({{{{-0.0502, 0.0, 0.0}}, 0.05}, {{{0.0502, 0.0, 0.0}}, 0.05}}, 0.003545);
    for (const double time : {0.05, 0.1, 0.15}) {
        advance_to(*solver, time);
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
        EXPECT_LT(scalar(*solver, "max_velocity"), 0.005);
    }
}

/// Three of 1257 coarse particles each: all three pairs of caps meet at 120 degrees, and no fold tears. It did after
/// 50 ms.
TEST(TripleBubble, SettlesFromFirstContact) {
    auto solver = settling_cluster(
        {{{{-0.0502, 0.0, 0.0}}, 0.05}, {{{0.0502, 0.0, 0.0}}, 0.05}, {{{0.0, 0.08695, 0.0}}, 0.05}}, 0.005);
    for (const double time : {0.03, 0.08}) {
        advance_to(*solver, time);
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
    advance_to(*solver, 0.03);
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b) {
            const double angle = angle_between(cap_of(*solver, a), cap_of(*solver, b));
            std::printf("caps %d and %d: %.2f degrees\n", a, b, angle);
            EXPECT_NEAR(angle, 120.0, 2.4);
        }
    EXPECT_LT(scalar(*solver, "density_spread"), 0.25);
    EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0);
}

/// The partition's curvature is the difference of those of the caps. [method sheet 14, V3, of table 5.2 in Deng22] The
/// table's radii are taken as those of the caps, and as those of the bubbles before they touch.
TEST(UnequalBubbles, HaveThePartitionThatTheirPressuresAskFor) {
    struct Case {
        double large, small, curvature, edge;
    };
    const std::array<Case, 12> cases{{{0.04978, 0.01629, 30.0, 0.00267},
                                      {0.04957, 0.02112, 20.0, 0.0024},
                                      {0.04926, 0.02616, 13.333, 0.0025},
                                      {0.04885, 0.03134, 8.571, 0.0025},
                                      {0.04837, 0.03661, 5.0, 0.0025},
                                      {0.04783, 0.04193, 2.222, 0.0025},
                                      {0.05, 0.02, 22.01, 0.0028},
                                      {0.05, 0.025, 14.83, 0.0025},
                                      {0.05, 0.03, 9.97, 0.0025},
                                      {0.05, 0.035, 6.44, 0.0025},
                                      {0.05, 0.04, 3.77, 0.0025},
                                      {0.05, 0.045, 1.679, 0.002}}};
    for (const Case& c : cases) {
        auto solver = settling_cluster(
            {{{{-1.004 * c.large, 0.0, 0.0}}, c.large}, {{{1.004 * c.small, 0.0, 0.0}}, c.small}}, c.edge);
        advance_to(*solver, 0.04);
        const Cap large = cap_of(*solver, 0), small = cap_of(*solver, 1);
        const double curvature = partition_curvature(*solver, 0, 1);
        std::printf("curvature %.3f of %.3f, of the caps %.3f; angle %.2f\n", curvature, c.curvature,
                    1.0 / small.radius - 1.0 / large.radius, angle_between(large, small));
        std::fflush(stdout);
        EXPECT_NEAR(curvature, c.curvature, 0.015 * c.curvature);
        EXPECT_NEAR(angle_between(large, small), 120.0, 1.2);
        for (const auto& [cap, r] : {std::pair{large, 0}, {small, 1}})
            EXPECT_NEAR(solver->gas()[r].balanced * cap.radius / (4.0 * 0.0725), 1.0, 0.01);
    }
}

/// Where the borders of three bubbles are, on the average: of particles of the first that see both others, near z = 0.
Vec3 border_of(const MelpSolver& solver, std::int32_t a, std::int32_t b, std::int32_t c) {
    Vec3 sum;
    double count = 0.0;
    for (std::size_t i = 0; i < solver.coarse().size(); ++i) {
        if (solver.coarse().region[i] != a || std::abs(solver.coarse().position[i][2]) > 0.005) continue;
        double seen_b = 0.0, seen_c = 0.0;
        for (const Share& share : shares_at(solver.coarse(), solver.geometry(), i)) {
            if (share.region == b) seen_b = share.gamma;
            if (share.region == c) seen_c = share.gamma;
        }
        const double weight = seen_b * seen_c;
        sum += weight * solver.coarse().position[i];
        count += weight;
    }
    return sum / count;
}

/// From region a to region b, of the film between them where it ends at `place`: the mean normal of its layers, turned
/// by how far the film bends from its middle to there, as the pressures say.
Vec3 film_normal(const MelpSolver& solver, std::int32_t a, std::int32_t b, const Vec3& place) {
    constexpr double kOnFilm = 0.5;
    Vec3 mean, middle;
    double count = 0.0;
    for (std::size_t i = 0; i < solver.coarse().size(); ++i) {
        const std::int32_t mine = solver.coarse().region[i];
        if (mine != a && mine != b) continue;
        for (const Share& share : shares_at(solver.coarse(), solver.geometry(), i)) {
            if (share.region != (mine == a ? b : a) || share.gamma < kOnFilm) continue;
            mean += (mine == a ? 1.0 : -1.0) * solver.geometry().normal[i];
            middle += solver.coarse().position[i];
            count += 1.0;
        }
    }
    mean = mean / norm(mean);
    const auto pressure = [&](std::int32_t r) { return solver.gas()[static_cast<std::size_t>(r)].balanced; };
    const Vec3 n = mean + ((pressure(a) - pressure(b)) / (4.0 * 0.025)) * (place - middle / count);
    return n / norm(n);
}

/// Four in a square, one diagonal 1 % shorter, fly at each other and would meet along one line, which is unstable: the
/// two on that diagonal join, and two borders remain. [method sheet 12]
TEST(FourBubbles, GoFromACrossToTwoBordersOf120Degrees) {
    auto solver = solver_of(R"(
[material]
surface_tension = 0.025
thickness = 5e-7
[[bubble]]
center = [-0.0203, -0.0203, 0.0]
radius = 0.02
velocity = [0.07, 0.07, 0.0]
[[bubble]]
center = [0.0207, -0.0207, 0.0]
radius = 0.02
velocity = [-0.07, 0.07, 0.0]
[[bubble]]
center = [-0.0207, 0.0207, 0.0]
radius = 0.02
velocity = [0.07, -0.07, 0.0]
[[bubble]]
center = [0.0203, 0.0203, 0.0]
radius = 0.02
velocity = [-0.07, -0.07, 0.0]
[resolution]
edge_length = 0.0025
[melp]
fine_ratio = 0
damping = 500.0
steps_per_period = 40.0
)");
    solver->start({});
    advance_to(*solver, 0.03);
    const auto film = [&](std::size_t a, std::size_t b) {
        return shared_film(solver->coarse(), solver->geometry(), 4, a)[b] / (std::numbers::pi * 0.02 * 0.02);
    };
    EXPECT_GT(film(0, 3), 0.3);
    EXPECT_EQ(film(1, 2), 0.0);
    for (const std::int32_t side : {1, 2}) {
        const Vec3 place = border_of(*solver, 0, 3, side);
        const std::int32_t ring[] = {0, 3, side, 0, 3};
        for (int k = 0; k < 3; ++k) {
            const double angle = 180.0 / std::numbers::pi *
                                 std::acos(dot(film_normal(*solver, ring[k], ring[k + 1], place),
                                               film_normal(*solver, ring[k + 1], ring[k + 2], place)));
            std::printf("border with bubble %d: %.2f degrees\n", side, angle);
            EXPECT_NEAR(angle, 120.0, 3.0);
        }
    }
}

}  // namespace
}  // namespace lamella::melp
