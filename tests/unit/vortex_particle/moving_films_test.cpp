// Films that move: bits, solids, bursts.

#include "lamella/core/parallel.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../../validation/vortex_particle/films.h"
#include "../sim/state_memory.h"
#include "same_runs.h"
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

using Memory = test::StateMemory;

/// Bubbles that swing, touch, are stirred, and of which one bursts; triangles change.
constexpr const char* kMoving = R"(
[material]
gravity = [0.0, 0.0, -9.81]
kinematic_viscosity = 1e-5
[[film]]
shape = "double_bubble"
volume = 1e-3
[[vortex]]
center = [0.06, 0.0, 0.02]
radius = 0.03
circulation = 0.02
[[solid]]
center = [0.06, 0.0, -0.02]
radius = 0.07
velocity = [0.0, 0.3, 0.0]
[resolution]
edge_length = 0.03
[[event]]
time = 0.02
region = 1
into = 2
[vortex_particle]
moving = true
[vortex_particle.noise]
thickness = 0.2
shape = 0.01
)";

void expect_equal_films(const VortexParticleSolver& a, const VortexParticleSolver& b) {
    expect_equal(a, b);
    EXPECT_EQ(a.films(), b.films());
}

TEST(MovingFilms, GiveTheSameBitsOnOneAndTwoThreads) {
    std::vector<std::unique_ptr<VortexParticleSolver>> runs;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        runs.push_back(solver_of(kMoving));
        runs.back()->start({});
        advance(*runs.back(), 0.03);
    }
    expect_equal_films(*runs[0], *runs[1]);
    EXPECT_EQ(runs[0]->surface().components, 1U);  // it has burst
}

/// Where a ball covers the film wholly: what the film lacks of the ball's velocity along it, over that, in the mean.
double lack_of_speed(const VortexParticleSolver& solver) {
    const Surface& s = solver.surface();
    const Cover cover = cover_of(s, solver.bodies(), 0.0);
    const Vec3 v = solver.bodies()[0].velocity;
    double lack = 0.0, speed = 0.0;
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        if (cover.share[t] < 1.0) continue;
        const Vec3 wanted = v - dot(v, s.normal[t]) * s.normal[t];
        lack += s.area[t] * norm(solver.observed().velocity[t] - wanted);
        speed += s.area[t] * norm(wanted);
    }
    return lack / speed;
}

/// Within what the triangles resolve. Where a ball is large against the bubble, or the film under it swings fast, the
/// film cannot: it would have to be squeezed.
TEST(MovingFilms, GoAlongWithSolids) {
    for (const char* film : {R"(
[[film]]
shape = "rectangle"
center = [-1, -1, 0]
u = [2, 0, 0]
v = [0, 2, 0]
[[solid]]
radius = 0.25
velocity = [1, 0, 0]
[resolution]
edge_length = 0.0625
[vortex_particle.noise]
shape = 0.01
)",
                             R"(
[[bubble]]
center = [0, 0, -0.3]
radius = 0.3
[[solid]]
radius = 0.08
velocity = [0.3, 0, 0]
[resolution]
edge_length = 0.02
)"}) {
        auto solver = solver_of(std::string(film) + R"(
[vortex_particle]
moving = true
particles_per_triangle = 5
)");
        solver->start({});
        advance(*solver, 0.02);
        EXPECT_LT(lack_of_speed(*solver), 0.04) << film;
        EXPECT_GT(norm(solver->bodies()[0].force), 0.0);
    }
}

TEST(MovingFilms, BurstWhereTheyAreAsThinAsAsked) {
    const auto after_a_step = [](const char* scene, const char* thickness) {
        auto solver = solver_of(
            scene, {fmt::format("material.thickness={}", thickness), "vortex_particle.rupture_thickness=0.7e-6"});
        solver->start({});
        solver->advance(1.0);
        return solver;
    };
    const auto liquid = [](const VortexParticleSolver& solver) {
        const auto& volume = solver.particles().volume;
        return std::accumulate(volume.begin(), volume.end(), 0.0);
    };
    // Halves of the film between the bubbles are thinner, but not the film.
    auto thick = after_a_step(kMoving, "1e-6");
    EXPECT_TRUE(thick->take_events().empty());
    auto thin = after_a_step(kMoving, "0.7e-6");
    EXPECT_EQ(thin->surface().components, 1U);  // there were two
    EXPECT_NEAR(liquid(*thin) / (0.7 * liquid(*thick)), 1.0, 1e-12);
    const auto events = thin->take_events();
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events[0].kind, "burst");
    EXPECT_FALSE(thin->stop_reason());
    constexpr const char* kLast = "[[bubble]]\nradius = 0.1\n[vortex_particle]\nmoving = true\n";
    EXPECT_TRUE(after_a_step(kLast, "0.7e-6")->stop_reason());
    EXPECT_FALSE(after_a_step(kLast, "1e-6")->stop_reason());
}

/// The half of a bubble in front of which it lies is seen from inside the bubble; when the other half bursts it is a
/// film that is seen from the other side, with the swirls that it had.
TEST(MovingFilms, KeepTheirSwirlsWhenTheirBubbleOpens) {
    auto solver = solver_of(R"(
[[film]]
shape = "ball_in_ring"
radius = 0.1
[[vortex]]
center = [0, 0, -0.1]
radius = 0.03
circulation = 0.02
[[event]]
time = 0.001
region = 1
into = 0
[resolution]
edge_length = 0.015
[vortex_particle]
moving = true
incompressible = true
largest_step = 0.0005
)");
    solver->start({});
    solver->advance(0.0005);
    const auto swirl = [&] {  // of the lowest film, around the axis
        const Surface& s = solver->surface();
        double sum = 0.0;
        for (std::size_t t = 0; t < s.triangles(); ++t) {
            const Vec3 x = s.point(t, {1.0 / 3, 1.0 / 3, 1.0 / 3}), u = solver->observed().velocity[t];
            if (x[2] < -0.07) sum += s.area[t] * (x[0] * u[1] - x[1] * u[0]);
        }
        return sum;
    };
    const double before = swirl();
    ASSERT_EQ(solver->surface().loops.size(), 0U);
    solver->advance(0.001);
    ASSERT_EQ(solver->surface().loops.size(), 1U);
    EXPECT_NEAR(swirl() / before, 1.0, 0.03);
}

TEST(MovingFilms, GoOnFromACheckpointWithTheSameBits) {
    auto whole = solver_of(kMoving);
    whole->start({});
    advance(*whole, 0.03);
    for (const std::int64_t stop : {1, 4, 11}) {
        auto first = solver_of(kMoving);
        first->start({});
        advance(*first, 0.03, stop);
        ASSERT_LT(first->time(), 0.03);
        Memory memory;
        first->save(memory);
        auto second = solver_of(kMoving);
        second->load(memory);
        for (std::size_t k = 0; k < first->scalars().size(); ++k)
            EXPECT_EQ(first->scalars()[k].value, second->scalars()[k].value) << first->scalars()[k].name << " " << stop;
        advance(*second, 0.03);
        expect_equal_films(*whole, *second);
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
