// Two bubbles that have just touched settle into the standard double bubble. [method sheet 14: V2, V4]

#include <gtest/gtest.h>

#include "caps.h"
#include <cstdio>
#include <utility>

namespace lamella::melp {
namespace {

TEST(DoubleBubble, SettlesFromFirstContact) {
    auto solver = solver_of(R"(
[material]
surface_tension = 0.0725
thickness = 5e-7
[[bubble]]
center = [-0.0502, 0.0, 0.0]
radius = 0.05
[[bubble]]
center = [0.0502, 0.0, 0.0]
radius = 0.05
[resolution]
edge_length = 0.003545
[melp]
fine_ratio = 0
theta = 1.0
damping = 500.0
steps_per_period = 90.0
)");
    solver->start({});
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
    auto solver = solver_of(R"(
[material]
surface_tension = 0.0725
thickness = 5e-7
[[bubble]]
center = [-0.0502, 0.0, 0.0]
radius = 0.05
[[bubble]]
center = [0.0502, 0.0, 0.0]
radius = 0.05
[[bubble]]
center = [0.0, 0.08695, 0.0]
radius = 0.05
[resolution]
edge_length = 0.005
[melp]
fine_ratio = 0
theta = 1.0
damping = 500.0
steps_per_period = 90.0
)");
    solver->start({});
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

}  // namespace
}  // namespace lamella::melp
