// Balls and sticks in films: what they may not do. Forces and shapes: tests/validation/melp/solids_test.cpp.

#include "lamella/solvers/melp/solids.h"

#include "lamella/core/error.h"
#include "lamella/solvers/melp/surface.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include "same_bits.h"
#include <limits>

namespace lamella::melp {
namespace {

/// A film on a frame with a stick that moves through it and a free ball that falls into it.
const std::string kStirred = R"(
seed = 11
[material]
gravity = [0.0, 0.0, -9.81]
[[film]]
shape = "rectangle"
u = [0.06, 0.0, 0.0]
v = [0.0, 0.06, 0.0]
[[solid]]
center = [0.02, 0.02, 0.0]
radius = 0.009
arm = [0.0, 0.004, 0.02]
velocity = [0.4, -0.2, 0.0]
end = 0.02
[[solid]]
center = [0.04, 0.04, 0.011]
radius = 0.009
velocity = [0.0, 0.0, -0.3]
free = true
mass = 5e-5
[resolution]
edge_length = 0.003
[melp]
fine_ratio = 4
start.thickness_noise = 0.5
)";

/// The smallest distance of any particle from a wet solid [m].
double nearest(const MelpSolver& solver) {
    double least = std::numeric_limits<double>::infinity();
    for (const film::Body& body : solver.bodies()) {
        for (const Vec3& x : solver.coarse().position) least = std::min(least, body.distance(x));
        for (const Vec3& x : solver.fine().position) least = std::min(least, body.distance(x));
    }
    return least;
}

TEST(Solids, AreEnteredByNoParticle) {
    auto solver = solver_of(kStirred);
    solver->start({});
    EXPECT_GE(nearest(*solver), 0.0);
    const double liquid = scalar(*solver, "liquid_mass");
    for (int k = 0; k < 80; ++k) {
        solver->advance(1e9);
        ASSERT_GE(nearest(*solver), -1e-9) << k;  // a millionth of a spacing, where a stick is round
    }
    EXPECT_NEAR(scalar(*solver, "liquid_mass") / liquid, 1.0, 1e-12);
    EXPECT_EQ(scalar(*solver, "strays"), 0.0);
    EXPECT_LT(scalar(*solver, "density_spread"), 1.0);
    EXPECT_GT(solver->bodies()[1].force[2], 0.0);  // the film carries the ball
}

TEST(Solids, GiveTheSameBitsOnAnyNumberOfThreadsAndAfterAResume) {
    expect_same_bits([] { return started(kStirred); }, 60, 37);
}

/// A heavy ball falls through its film, which closes behind it.
TEST(Solids, LeaveAWholeFilmBehind) {
    auto solver = films(
        "[[film]]\nshape = \"disk\"\nradius = 0.05\n[[solid]]\ncenter = [0.0, 0.0, 0.012]\nradius = 0.009\n"
        "velocity = [0.0, 0.0, -0.8]\n",
        0.003, "fine_ratio = 4\ndamping = 60.0\n");
    advance_to(*solver, 0.015);
    EXPECT_GT(open_edges(solver->frame().surface.triangles), 30U);  // around the ball; the rim is joined to its ring
    advance_to(*solver, 0.2);
    const sim::Surface surface = solver->frame().surface;
    std::size_t outside = 0;  // open edges that lie on the ring
    for (const double on_wire : surface.vertex_fields.back().values) outside += on_wire != 0.0 ? 1 : 0;
    EXPECT_EQ(open_edges(surface.triangles), outside);
    for (const Vec3& x : solver->coarse().position) EXPECT_NEAR(x[2], 0.0, 1e-3);
    EXPECT_NEAR(scalar(*solver, "particle_area") / (std::numbers::pi * 0.05 * 0.05), 1.0, 0.01);
    EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
}

TEST(Solids, BurstFilmsWhenTheyAreDry) {
    auto solver = films(
        "[[film]]\nshape = \"disk\"\nradius = 0.03\n[[solid]]\ncenter = [0.0, 0.0, 0.01]\nradius = 0.004\n"
        "velocity = [0.0, 0.0, -1.0]\narm = [0.0, 0.0, 0.004]\nwet = false\n",
        0.002, "");
    advance_to(*solver, 0.0019);
    EXPECT_TRUE(solver->take_events().empty());
    advance_to(*solver, 0.0025);
    const auto events = solver->take_events();
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].kind, "puncture");
    EXPECT_NEAR(events[0].time, 0.002, 4e-4);
    EXPECT_LT(norm(events[0].position), 0.005);

    for (const double center : {0.0235, 0.0225}) {
        auto bubble = films("[[bubble]]\nradius = 0.02\n[[solid]]\nradius = 0.003\nwet = false\ncenter = [0.0, 0.0, " +
                                std::to_string(center) + "]\n",
                            0.0025, "");
        EXPECT_EQ(bubble->gas()[0].burst, center < 0.023);
    }
}

TEST(Solids, AreRefusedWhereTheyAreNotBuilt) {
    const std::string disk =
        "[[film]]\nshape = \"disk\"\nradius = 0.05\n[resolution]\nedge_length = 0.003\n[[solid]]\n";
    EXPECT_NO_THROW(solver_of(disk + "radius = 0.01\n"));
    EXPECT_THROW(solver_of("[[bubble]]\nradius = 0.02\n[[solid]]\nradius = 0.01\n"), InputError);
    EXPECT_THROW(solver_of(disk + "radius = 0.008\n"), InputError);
    EXPECT_THROW(solver_of(disk + "radius = 0.01\nspin = [0.0, 0.0, 1.0]\n"), InputError);
    EXPECT_THROW(solver_of(disk + "radius = 0.01\nfree = true\n"), InputError);
    EXPECT_THROW(solver_of(disk + "radius = 0.01\nfree = true\nmass = 1e-5\narm = [0.0, 0.0, 0.01]\n"), InputError);
    EXPECT_THROW(solver_of(disk + "radius = 0.01\nwet = false\n[melp]\nfine_ratio = 0\n"), InputError);
    EXPECT_THROW(solver_of(disk + "radius = 0.06\n")->start({}), InputError);
}

}  // namespace
}  // namespace lamella::melp
