// A crowd of bubbles that fall, touch, join and are pressed together at seven spacings to a radius.

#include "lamella/solvers/melp/redistribution.h"

#include <gtest/gtest.h>

#include "../../unit/melp/bubbles.h"
#include <algorithm>
#include <cstdio>
#include <string>

namespace lamella::melp {
namespace {

std::string faucet(double x, double y, int number) {
    return "[[faucet]]\ncenter = [" + std::to_string(x) + ", " + std::to_string(y) +
           ", 0.16]\nvelocity = [0, 0, -0.8]\nwidth = 0.012\ncount = 12\nradius = 0.01\nradius_spread = 0.1\nstart = " +
           std::to_string(0.006 * number) + "\ninterval = 0.01\n";
}

std::string wall(double x, double y) {
    return "[[wall]]\npoint = [" + std::to_string(-0.032 * x) + ", " + std::to_string(-0.032 * y) +
           ", 0.0]\nnormal = [" + std::to_string(x) + ", " + std::to_string(y) + ", 0.0]\n";
}

/// Normals on folds used to swing from face to face between steps; particles there were pulled out of their films,
/// which tore after 0.19 s.
TEST(Crowd, StaysWholeInALowBoxWithLongSteps) {
    std::string scene =
        "seed = 3\n[material]\nsurface_tension = 0.025\nthickness = 5e-7\ngravity = [0.0, 0.0, -9.81]\n"
        "[resolution]\nedge_length = 0.0015\n[[wall]]\nnormal = [0, 0, 1]\n";
    for (const double side : {1.0, -1.0}) scene += wall(side, 0.0) + wall(0.0, side);
    scene += faucet(0.0, 0.0, 0) + faucet(-0.0125, -0.0125, 1) + faucet(0.0125, -0.0125, 2) +
             faucet(0.0125, 0.0125, 3) + faucet(-0.0125, 0.0125, 4);
    scene +=
        "[melp]\nfine_ratio = 0\njoining_delay = 0.1\ndamping = 12.0\nshape_damping = 20000.0\nsteps_per_period = 0\n"
        "largest_step = 1e-3\ncfl = 1.0\n";
    auto solver = solver_of(scene);
    solver->start({});
    double widest = 0.0;
    for (const double time : {0.1, 0.15, 0.2, 0.25, 0.3, 0.35}) {
        advance_to(*solver, time);
        widest = std::max(widest, scalar(*solver, "density_spread"));
        EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0) << time;
        EXPECT_LT(std::abs(scalar(*solver, "liquid_error")), 1e-12) << time;
    }
    std::printf("crowd of %.0f bubbles, %zu coarse: widest spread %.2f, at the end %.2f\n", scalar(*solver, "bubbles"),
                solver->coarse().size(), widest, scalar(*solver, "density_spread"));
    EXPECT_GT(scalar(*solver, "bubbles"), 30.0);
    EXPECT_LT(widest, 0.3);
    EXPECT_LT(scalar(*solver, "density_spread"), 0.3);
}

/// Bubbles change their neighbors under a jet of others: the edge of one goes back by half a spacing per step. Its
/// particles used to pile up there, to a spread of 3.5, where shifts along the film were at most a tenth of the
/// spacing.
TEST(Crowd, StaysEvenWhereBubblesChangeTheirNeighbors) {
    std::string scene =
        "seed = 11\n[material]\nsurface_tension = 0.025\nthickness = 5e-7\ngravity = [0.0, 0.0, -9.81]\n"
        "[resolution]\nedge_length = 0.0015\n[[wall]]\nnormal = [0, 0, 1]\n";
    for (const double side : {1.0, -1.0})
        for (const Vec3& normal : {Vec3{{side, 0.0, 0.0}}, Vec3{{0.0, side, 0.0}}})
            scene += "[[wall]]\npoint = [" + std::to_string(-0.028 * normal[0]) + ", " +
                     std::to_string(-0.028 * normal[1]) + ", 0.0]\nnormal = [" + std::to_string(normal[0]) + ", " +
                     std::to_string(normal[1]) + ", 0.0]\n";
    scene +=
        "[[faucet]]\ncenter = [0, 0, 0.2]\nvelocity = [0, 0, -0.8]\nwidth = 0.017\ncount = 40\nradius = 0.01\n"
        "radius_spread = 0.1\ninterval = 0.01\n"
        "[melp]\nfine_ratio = 0\nsolver_tolerance = 1e-4\njoining_delay = 0.1\ndamping = 12.0\n"
        "shape_damping = 20000.0\nsteps_per_period = 0\nlargest_step = 1e-3\ncfl = 1.0\n";
    auto solver = solver_of(scene);
    solver->start({});
    double widest = 0.0;
    while (solver->time() < 0.33) {
        solver->advance(0.33);
        widest = std::max(widest, density_spread(solver->geometry(), solver->coarse(), solver->gas().size()));
    }
    std::printf("jet of bubbles, %zu coarse: widest spread %.2f\n", solver->coarse().size(), widest);
    EXPECT_LT(widest, 1.2);
    EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0);
}

}  // namespace
}  // namespace lamella::melp
