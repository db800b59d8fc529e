#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/melp/pair_forces.h"
#include "lamella/solvers/melp/start.h"
#include "lamella/solvers/melp/surface.h"

#include <gtest/gtest.h>

#include "bubbles.h"

namespace lamella::melp {
namespace {

/// A bubble that flies in the wind and drains while its liquid is uneven.
constexpr const char* kBusy = R"(
seed = 3
[material]
gravity = [0.0, 0.0, -9.81]
[[bubble]]
radius = 0.02
velocity = [0.2, 0.0, 0.0]
[resolution]
edge_length = 0.003
[melp]
air_drag = 1e-3
wind = [0.0, 1.0, 0.0]
start.thickness_noise = 0.5
)";

/// Two that touch.
constexpr const char* kPair = R"(
[[bubble]]
center = [-0.0201, 0.0, 0.0]
radius = 0.02
velocity = [0.2, 0.0, 0.0]
[[bubble]]
center = [0.0151, 0.0, 0.0]
radius = 0.015
[resolution]
edge_length = 0.0015
[melp]
fine_ratio = 0
damping = 500.0
)";

/// A film on a frame, one side of which moves, that drains.
constexpr const char* kFrame = R"(
seed = 5
[material]
gravity = [0.0, 0.0, -9.81]
[[film]]
shape = "rectangle"
u = [0.03, 0.0, 0.0]
v = [0.0, 0.0, 0.03]
[[wire]]
shape = "segment"
from = [0.0, 0.0, 0.03]
to = [0.03, 0.0, 0.03]
velocity = [0.0, 0.3, 0.1]
spin = [0.0, 0.0, 2.0]
[resolution]
edge_length = 0.003
[melp]
start.thickness_noise = 0.5
)";

/// Half a bubble on a wet plate.
constexpr const char* kHalfBubble = R"(
seed = 7
[[film]]
shape = "hemisphere"
radius = 0.02
[resolution]
edge_length = 0.003
[melp]
rim = "wet_plate"
start.thickness_noise = 0.5
start.mode_amplitude = 0.05
)";

/// A bubble that is pricked after a few steps.
constexpr const char* kBurst = R"(
seed = 2
[material]
gravity = [0.0, 0.0, -9.81]
[[bubble]]
radius = 0.02
[[event]]
kind = "puncture"
time = 1e-4
center = [0.02, 0.0, 0.0]
radius = 0.006
[resolution]
edge_length = 0.0025
[melp]
start.thickness_noise = 0.3
)";

/// Three that touch, with a flow in their films.
constexpr const char* kTriple = R"(
[material]
gravity = [0.0, 0.0, -9.81]
[[bubble]]
center = [-0.02, 0.0, 0.0]
radius = 0.0199
[[bubble]]
center = [0.02, 0.0, 0.0]
radius = 0.0199
velocity = [-0.1, 0.0, 0.0]
[[bubble]]
center = [0.0, 0.0346, 0.0]
radius = 0.0199
[resolution]
edge_length = 0.0033
[melp]
fine_ratio = 4
damping = 1000.0
start.thickness_noise = 0.5
)";

TEST(MelpSolver, GivesTheSameBitsOnOneAndTwoThreads) {
    for (const char* scene : {kBusy, kPair, kFrame, kHalfBubble, kBurst, kTriple}) {
        std::vector<test::StateMemory> states;
        for (const int threads : {1, 2}) {
            const ThreadLimit limit(threads);
            auto solver = solver_of(scene);
            solver->start({});
            advance(*solver, 40);
            states.push_back(state_of(*solver));
        }
        EXPECT_EQ(states[0].reals, states[1].reals);
        EXPECT_EQ(states[0].integers, states[1].integers);
    }
}

TEST(MelpSolver, GoesOnFromACheckpointWithTheSameBits) {
    constexpr int kSteps = 40;
    for (const char* scene : {kBusy, kPair, kFrame, kHalfBubble, kBurst, kTriple}) {
        auto whole = solver_of(scene);
        whole->start({});
        advance(*whole, kSteps);
        const test::StateMemory expected = state_of(*whole);
        for (const int stop : {0, 7, 33}) {
            auto first = solver_of(scene);
            first->start({});
            advance(*first, stop);
            test::StateMemory memory = state_of(*first);
            auto second = solver_of(scene);
            second->load(memory);
            advance(*second, kSteps - stop);
            EXPECT_EQ(state_of(*second).reals, expected.reals) << stop;
            EXPECT_EQ(state_of(*second).integers, expected.integers) << stop;
            EXPECT_EQ(second->frame().surface.triangles, whole->frame().surface.triangles);
        }
    }
}

TEST(MelpSolver, RefusesACheckpointThatIsNone) {
    auto solver = solver_of(kBusy);
    solver->start({});
    for (const char* name : {"coarse/count", "fine/count", "regions"}) {
        test::StateMemory memory = state_of(*solver);
        memory.integers[name][0] = -1;
        auto other = solver_of(kBusy);
        EXPECT_THROW(other->load(memory), InputError) << name;
    }
    test::StateMemory memory = state_of(*solver);
    memory.integers["coarse/region"][0] = 7;
    auto other = solver_of(kBusy);
    EXPECT_THROW(other->load(memory), InputError);
}

TEST(MelpSolver, RefusesFilmsAndOptionsThatItDoesNotKnow) {
    const std::string ball = "[[bubble]]\nradius = 0.02\n";
    EXPECT_THROW(solver_of("[[film]]\nshape = \"disk\"\n[melp]\nrim = \"plate\"\n"), InputError);
    EXPECT_THROW(solver_of("[[film]]\nshape = \"frame\"\n"), InputError);
    EXPECT_THROW(solver_of("[[film]]\nshape = \"hemisphere\"\n[melp]\nstart.mode_amplitude = 0.1\n"), InputError);
    EXPECT_THROW(solver_of(std::string(kFrame) + "[[wire]]\nshape = \"ring\"\nblow = 1.0\n"), InputError);
    EXPECT_THROW(solver_of("[[film]]\nshape = \"kelvin\"\n"), InputError);
    EXPECT_THROW(solver_of(ball + "[[event]]\nkind = \"inflate\"\nfactor = 2.0\n"), InputError);
    EXPECT_THROW(solver_of(ball + "[[event]]\nregion = 0\n"), InputError);
    EXPECT_THROW(solver_of(std::string(kBurst) + "fine_ratio = 0\n"), InputError);
    EXPECT_THROW(solver_of(ball + "[[tension]]\nb = 1\nfactor = 2.0\n"), InputError);
    EXPECT_THROW(solver_of(ball + "[material]\nsurfactant = 2e-5\n"), InputError);
    EXPECT_THROW(solver_of(ball + "[melp]\nfine_ratio = -1\n"), InputError);
    EXPECT_THROW(solver_of(kPair, {"resolution.edge_length=0.003"}), InputError);
    EXPECT_NO_THROW(solver_of(kPair));
    EXPECT_NO_THROW(solver_of(ball));
}

TEST(MelpSolver, LandsOnTheTimeLimit) {
    auto solver = solver_of(kBusy);
    solver->start({});
    const double limit = 0.0011;
    for (int k = 0; k < 100 && solver->time() < limit; ++k) solver->advance(limit);
    EXPECT_EQ(solver->time(), limit);
}

TEST(MelpSolver, ConservesLiquidAndSurfactantToRounding) {
    for (const char* scene : {kBusy, kFrame, kHalfBubble, kTriple}) {
        auto solver = solver_of(scene);
        solver->start({});
        const double liquid = scalar(*solver, "liquid_mass"), surfactant = scalar(*solver, "surfactant_amount");
        advance(*solver, 100);
        EXPECT_NEAR(scalar(*solver, "liquid_mass") / liquid, 1.0, 1e-12);
        EXPECT_NEAR(scalar(*solver, "surfactant_amount") / surfactant, 1.0, 1e-12);
        EXPECT_EQ(scalar(*solver, "strays"), 0.0);
        double on_coarse = 0.0;  // what the fine particles have given is all there
        for (const double v : solver->films().liquid_volume) on_coarse += v;
        EXPECT_NEAR(1000.0 * on_coarse / liquid, 1.0, 1e-6);
    }
}

/// A ring carries its film along, across the film and along it, and turns it.
TEST(MelpSolver, MovesAFilmWithItsRing) {
    auto solver = solver_of(R"(
[[film]]
shape = "disk"
radius = 0.02
[[wire]]
radius = 0.02
velocity = [0.1, 0.0, 0.3]
spin = [1.0, 0.0, 0.0]
[resolution]
edge_length = 0.002
[melp]
damping = 1000.0
)");
    solver->start({});
    const double end = 0.2;
    advance_to(*solver, end);
    const Vec3 center = end * Vec3{{0.1, 0.0, 0.3}}, axis{{0.0, -std::sin(end), std::cos(end)}};
    for (const Vec3& x : solver->coarse().position) {
        EXPECT_NEAR(dot(x - center, axis), 0.0, 3e-4);
        EXPECT_LT(norm(x - center), 0.02);
    }
    EXPECT_EQ(scalar(*solver, "strays"), 0.0);
    EXPECT_LT(scalar(*solver, "density_spread"), 0.3);
}

/// A bubble that bursts ends as drops: all of its liquid is there, no number is lost, the frame shows a hole on the
/// way, and no shreds are thrown.
TEST(MelpSolver, BurstsABubbleToTheEnd) {
    auto solver = solver_of(kBurst);
    solver->start({});
    EXPECT_EQ(open_edges(solver->frame().surface.triangles), 0U);
    const std::size_t particles = solver->fine().size();
    advance_to(*solver, 2e-3);
    EXPECT_GT(open_edges(solver->frame().surface.triangles), 10U);
    const auto events = solver->take_events();
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].kind, "puncture");
    EXPECT_NEAR(events[0].position[0], 0.02, 0.003);
    double fastest = 0.0;
    for (int k = 0; k < 3000 && solver->time() < 0.02; ++k) {
        solver->advance(0.02);
        for (const Vec3& u : solver->coarse().velocity) fastest = std::max(fastest, norm(u));
    }
    EXPECT_EQ(solver->time(), 0.02);
    EXPECT_LT(solver->coarse().size(), 100U);
    const double edge = std::sqrt(2.0 * 0.025 / (1000.0 * 3.2e-7));  // of the thinnest film
    EXPECT_LT(fastest, 2.5 * edge);
    EXPECT_EQ(solver->fine().size(), particles);
    EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
    for (const Vec3& x : solver->fine().position) EXPECT_TRUE(std::isfinite(squared_norm(x)));
    for (const sim::Scalar& s : solver->scalars()) EXPECT_TRUE(std::isfinite(s.value)) << s.name;
}

TEST(Cohesion, FollowsFromOneEnergy) {
    for (const double beta : {0.0, 0.3, 0.6}) {
        double f = 0.0;  // the integral of the slope
        constexpr double kStep = 1e-4;
        for (double gamma = 0.0; gamma < 2.5; gamma += kStep) {
            const Cohesion c = cohesion(gamma, beta);
            EXPECT_NEAR(c.own, 2.0 - f - gamma * c.other, 1e-3) << gamma;
            EXPECT_GE(c.own, 0.9 * beta - 1e-12) << gamma;  // no film pushes
            f += kStep * cohesion(gamma + 0.5 * kStep, beta).other;
        }
    }
}

TEST(StarVolumes, AddUpToALopsidedBubble) {
    constexpr double kAmplitude = 0.2;
    auto solver = bubble(2000, "fine_ratio = 0\nstart.mode = 3\nstart.mode_amplitude = 0.2\n");
    double exact = 0.0;
    constexpr int kSlices = 2000;
    for (int k = 0; k < kSlices; ++k)
        exact += 2.0 * std::numbers::pi / 3.0 * 2.0 / kSlices *
                 std::pow(kRadius * (1.0 + kAmplitude * legendre(3, (2 * k + 1.0) / kSlices - 1.0)), 3);
    double sum = 0.0;
    VoronoiCell cell;
    const std::vector<Vec3>& x = solver->coarse().position;
    const Geometry& g = solver->geometry();
    for (std::size_t i = 0; i < x.size(); ++i)
        sum += star_of(x, g.normal, g.neighbors.same, i, cell).volume(x[i], Vec3{});
    EXPECT_NEAR(sum / exact, 1.0, 1.5e-3);
}

TEST(SurfaceTriangles, CloseABubbleInWhileItSwingsAndFlies) {
    auto solver = bubble(800, "fine_ratio = 0\nstart.mode = 3\nstart.mode_amplitude = 0.1\n");
    for (int k = 0; k < 4; ++k) {
        const sim::Surface surface = solver->frame().surface;
        EXPECT_EQ(open_edges(surface.triangles), 0U) << k;
        EXPECT_EQ(surface.triangles.size(), 2 * solver->coarse().size() - 4) << k;  // Euler's formula for a sphere
        double volume = 0.0;
        for (const auto& t : surface.triangles)
            volume += dot(surface.position[t[0]], cross(surface.position[t[1]], surface.position[t[2]])) / 6.0;
        EXPECT_NEAR(volume / scalar(*solver, "particle_volume"), 1.0, 0.02) << k;  // a polyhedron inside the sphere
        advance(*solver, 15);
    }
}

TEST(SurfaceTriangles, LeaveAHoleInAFilmOpen) {
    CoarseParticles coarse;
    for (const Vec3& n : fibonacci_sphere(600))
        if (n[0] < 0.8) {
            coarse.position.push_back(n);
            coarse.frame_normal.push_back(n);
        }
    coarse.velocity.resize(coarse.size());
    coarse.region.resize(coarse.size());
    const Triangles triangles = surface_triangles(coarse, geometry_of(coarse, 0.45));
    EXPECT_GT(open_edges(triangles), 10U);  // around the hole
    EXPECT_LT(open_edges(triangles), 60U);
}

}  // namespace
}  // namespace lamella::melp
