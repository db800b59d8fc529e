// Holes in films open with the speed of Taylor and Culick, sqrt(2 sigma / (rho eta)).

#include <gtest/gtest.h>

#include "../../unit/melp/bubbles.h"
#include <algorithm>

namespace lamella::melp {
namespace {

/// Mean distance from the axis z of the innermost coarse particle in each of 24 sectors [m].
double hole_radius(const MelpSolver& solver) {
    constexpr std::size_t kSectors = 24;
    std::vector<double> nearest(kSectors, 1.0);
    for (const Vec3& x : solver.coarse().position) {
        const double turn = std::atan2(x[1], x[0]) / (2.0 * std::numbers::pi) + 0.5;
        double& least = nearest[std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1)];
        least = std::min(least, std::hypot(x[0], x[1]));
    }
    double sum = 0.0;
    for (const double r : nearest) sum += r / kSectors;
    return sum;
}

TEST(Burst, HoleInADiskGrowsWithTheSpeedOfTaylorAndCulick) {
    auto solver = solver_of(R"(
[material]
liquid_density = 1000.0
surfactant = 1e-7
surface_tension = 0.03
thickness = 5e-7
[[film]]
shape = "disk"
radius = 0.05
[[event]]
kind = "puncture"
radius = 0.005
[resolution]
edge_length = 0.002
)");
    solver->start({});
    double n = 0.0, t1 = 0.0, t2 = 0.0, r1 = 0.0, tr = 0.0;
    while (hole_radius(*solver) < 0.035 && solver->time() < 0.01) {
        solver->advance(1.0);
        const double r = hole_radius(*solver), t = solver->time();
        if (r < 0.015) continue;
        n += 1.0;
        t1 += t;
        t2 += t * t;
        r1 += r;
        tr += t * r;
    }
    const double speed = (tr - t1 * r1 / n) / (t2 - t1 * t1 / n), exact = std::sqrt(2.0 * 0.03 / (1000.0 * 5e-7));
    std::printf("edge: %.3f of %.3f m/s, %zu coarse left, %.0f drops, liquid %.1e, %.0f steps\n", speed / exact, exact,
                solver->coarse().size(), scalar(*solver, "strays"), scalar(*solver, "liquid_error"), n);
    EXPECT_NEAR(speed / exact, 1.0, 0.05);
    EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
}

}  // namespace
}  // namespace lamella::melp
