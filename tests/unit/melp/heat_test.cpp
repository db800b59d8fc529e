// Heat, wind that turns, and how the surfactant is found: what they may and may not do. Closed forms:
// tests/validation/melp/heat_test.cpp.

#include "lamella/solvers/melp/heat.h"

#include "lamella/core/error.h"
#include "lamella/solvers/melp/surfactant.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include "same_bits.h"

namespace lamella::melp {
namespace {

TEST(Heat, IsLinearInHeightOrDistance) {
    HeatOptions options{.source = HeatSource::kBelow, .temperature = 320.0, .center = {{0, 0, 1.0}}, .reach = 0.5};
    const Vec3 up{{0, 0, 1}};
    EXPECT_EQ(Heat(options, 300.0, up).air({{5.0, 0, 2.0}}), 300.0);
    EXPECT_NEAR(Heat(options, 300.0, up).air({{5.0, 0, 0.75}}), 310.0, 1e-12);
    EXPECT_NEAR(Heat(options, 300.0, up).air({{5.0, 0, -1.0}}), 320.0, 1e-12);
    options.source = HeatSource::kBall;
    EXPECT_NEAR(Heat(options, 300.0, up).air({{0.25, 0, 1.0}}), 310.0, 1e-12);
    EXPECT_EQ(Heat(options, 300.0, up).air({{0.5, 0, 1.0}}), 300.0);
    options.source = HeatSource::kNone;
    EXPECT_EQ(Heat(options, 300.0, up).extra_tension(400.0), 0.0);
}

TEST(Heat, GivesTheSameBitsOnAnyNumberOfThreadsAndAfterAResume) {
    expect_same_bits(
        [] {
            return bubble(300,
                          "floating = true\nfine_ratio = 4\nwind_spin = [0.0, 0.0, 3.0]\nair_drag = 1e-3\n"
                          "start.thickness_noise = 0.3\n[melp.heat]\nsource = \"ball\"\ntemperature = 300.0\n"
                          "center = [0.0, 0.0, -0.05]\nreach = 0.05\n",
                          "gravity = [0.0, 0.0, -9.81]");
        },
        30, 13);
}

TEST(Heat, IsRefusedWhereItMakesNoSense) {
    const std::string scene = "[[bubble]]\nradius = 0.02\n[melp]\nheat.source = \"below\"\n";
    EXPECT_NO_THROW(solver_of(scene + "heat.temperature = 310.0\nheat.reach = 0.1\n"));
    EXPECT_THROW(solver_of(scene + "heat.reach = 0.1\n"), InputError);
    EXPECT_THROW(solver_of(scene + "heat.temperature = 310.0\n"), InputError);
    EXPECT_THROW(solver_of(scene + "heat.temperature = 310.0\nheat.reach = 0.1\nfine_ratio = 0\n"), InputError);
    EXPECT_THROW(solver_of(scene + "heat.temperature = 900.0\nheat.reach = 0.1\n"), InputError);
    EXPECT_THROW(solver_of(scene + "heat.temperature = 310.0\nheat.reach = 0.1\nheat.time = 0.0\n"), InputError);
}

/// Relaxed sweeps come to what conjugate gradients find, in the end; the published 30 have not.
TEST(Surfactant, IsFoundByManyJacobiSweeps) {
    const auto solver = bubble(500, "fine_ratio = 8\nstart.thickness_noise = 0.6\n");
    const std::vector<double> inertia(solver->coarse().size(), kFilmMass);
    const film::SurfactantLaw law{kTension, 1e-7, 298.15};
    const auto solve = [&](int sweeps) {
        return solve_surfactant(solver->geometry(), solver->coarse().position, solver->films(),
                                solver->coarse().velocity, law, inertia, 1.0 / 30.0, 1e-12, sweeps)
            .pressing;
    };
    const auto exact = solve(0);
    const auto error = [&](int sweeps) {
        const auto found = solve(sweeps);
        double left = 0.0, moved = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            left += (found[i] - exact[i]) * (found[i] - exact[i]);
            moved += (solver->films().pressing[i] - exact[i]) * (solver->films().pressing[i] - exact[i]);
        }
        return std::sqrt(left / moved);
    };
    std::printf("left of the way after 30, 100, 1000 sweeps: %.3f, %.3f, %.1e\n", error(30), error(100), error(1000));
    EXPECT_GT(error(30), 0.05);
    EXPECT_LT(error(100), error(30));
    EXPECT_LT(error(10000), 1e-9);
}

}  // namespace
}  // namespace lamella::melp
