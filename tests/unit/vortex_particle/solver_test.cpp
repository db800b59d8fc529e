#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include <gtest/gtest.h>

#include "../../validation/vortex_particle/films.h"
#include "../sim/state_memory.h"
#include "same_runs.h"
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

using Memory = test::StateMemory;

/// A curved film with a hole, everything on: gravity, uneven liquid, viscosity, drag, a flow around the hole.
constexpr const char* kBusy = R"(
[material]
gravity = [0.0, 0.0, -9.81]
kinematic_viscosity = 1e-4
[[film]]
shape = "catenoid"
radius = 0.5
separation = 0.4
[[vortex]]
center = [0.45, 0.0, 0.05]
radius = 0.1
circulation = 0.3
[[vortex]]
profile = "hole"
circulation = 0.5
[resolution]
edge_length = 0.08
[time]
end = 1.0
[vortex_particle]
air_drag = 0.1
[vortex_particle.noise]
thickness = 0.3
surfactant = 0.2
)";

/// A stream around a disk that is held, a free one, and a leg that steps.
constexpr const char* kStreaming = R"(
[material]
kinematic_viscosity = 1e-3
[[film]]
shape = "rectangle"
center = [0, -1, 0]
u = [3, 0, 0]
v = [0, 2, 0]
[[solid]]
center = [0.8, 0.3, 0]
radius = 0.25
[[solid]]
center = [0.8, -0.4, 0]
radius = 0.25
free = true
mass = 1e-3
[[solid]]
center = [2.0, 0.0, 0]
radius = 0.2
velocity = [0, 1, 0]
end = 0.1
period = 0.2
[resolution]
edge_length = 0.1
[time]
end = 1.0
[vortex_particle]
incompressible = true
largest_step = 0.02
[vortex_particle.stream]
velocity = [1, 0, 0]
)";

/// Films that meet in triple lines, over which liquid runs with its swirls.
constexpr const char* kSheets = R"(
[material]
gravity = [3.0, 0.0, -9.81]
surfactant = 8e-7
[[film]]
shape = "frame"
frame = "cube"
edge = 1.0
[[vortex]]
center = [0.3, 0.0, 0.3]
radius = 0.1
circulation = 0.2
[resolution]
edge_length = 0.1
[vortex_particle]
junction = "sheets"
largest_step = 0.02
)";

TEST(VortexParticleSolver, GivesTheSameBitsOnOneAndTwoThreads) {
    for (const char* scene : {kBusy, kStreaming, kSheets})
        for (const char* transfer : {"hat", "kernel"}) {
            std::vector<std::unique_ptr<VortexParticleSolver>> runs;
            for (const int threads : {1, 2}) {
                const ThreadLimit limit(threads);
                runs.push_back(solver_of(scene, {std::string("vortex_particle.transfer=") + transfer}));
                runs.back()->start({});
                advance(*runs.back(), 0.3);
            }
            expect_equal(*runs[0], *runs[1]);
        }
}

TEST(VortexParticleSolver, GoesOnFromACheckpointWithTheSameBits) {
    for (const char* scene : {kBusy, kStreaming, kSheets}) {
        auto whole = solver_of(scene);
        whole->start({});
        advance(*whole, 0.3);
        for (const std::int64_t stop : {1, 2, 7, 14}) {
            auto first = solver_of(scene);
            first->start({});
            advance(*first, 0.3, stop);
            ASSERT_LT(first->time(), 0.3);
            Memory memory;
            first->save(memory);
            auto second = solver_of(scene);
            second->load(memory);
            advance(*second, 0.3);
            expect_equal(*whole, *second);
        }
    }
}

TEST(VortexParticleSolver, KeepsLiquidSurfactantAndCirculation) {
    auto solver = solver_of(R"(
[material]
gravity = [0.0, 0.0, -9.81]
[[bubble]]
center = [0.0, 0.0, 0.0]
radius = 0.3
[[vortex]]
center = [0.3, 0.0, 0.0]
radius = 0.1
circulation = 0.3
[resolution]
edge_length = 0.05
[vortex_particle.noise]
thickness = 0.3
surfactant = 0.2
)");
    solver->start({});
    const auto sum = [](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
    const double liquid = sum(solver->particles().volume), soap = sum(solver->particles().amount);
    advance(*solver, 1.0);
    // The columns are only moved: their sums may differ by the order of adding, n^(1/2) roundings or so.
    EXPECT_NEAR(sum(solver->particles().volume) / liquid, 1.0, 1e-13);
    EXPECT_NEAR(sum(solver->particles().amount) / soap, 1.0, 1e-13);
    double size = 0.0;
    for (const double c : solver->particles().circulation) size += std::abs(c);
    EXPECT_LT(std::abs(sum(solver->particles().circulation)), 1e-12 * size);
    EXPECT_GT(size, 0.1);
}

TEST(VortexParticleSolver, CarriesLiquidAndSwirlsOverTripleLines) {
    auto solver = solver_of(kSheets);
    solver->start({});
    const auto film_of = [&](std::size_t p) {
        const Surface& s = solver->surface();
        return s.component[s.corner[solver->particles().triangle[p]][0]];
    };
    const auto liquid = [&] {
        std::vector<double> sum(solver->surface().components, 0.0);
        for (std::size_t p = 0; p < solver->particles().size(); ++p) sum[film_of(p)] += solver->particles().volume[p];
        return sum;
    };
    ASSERT_EQ(solver->surface().components, 12U);
    const std::vector<double> before = liquid();
    advance(*solver, 0.5);
    const std::vector<double> after = liquid();
    double moved = 0.0, total = 0.0, all = 0.0;
    for (std::size_t c = 0; c < before.size(); ++c) {
        moved += std::abs(after[c] - before[c]);
        total += before[c];
        all += after[c];
    }
    EXPECT_NEAR(all / total, 1.0, 1e-13);
    EXPECT_GT(moved, 0.02 * total);
    const auto& circulation = solver->particles().circulation;
    for (std::size_t p = 0; p < circulation.size(); ++p) ASSERT_TRUE(std::isfinite(circulation[p]));
}

TEST(VortexParticleSolver, RefusesWhatItCannotDo) {
    EXPECT_THROW(
        solver_of("[[bubble]]\ncenter=[0,0,0]\nradius=1.0\n[vortex_particle]\nmoving=true\njunction=\"sheets\"\n"),
        InputError);
    EXPECT_THROW(solver_of("[[film]]\nshape=\"frame\"\n"), InputError);
    EXPECT_THROW(
        solver_of("[[bubble]]\ncenter=[0,0,0]\nradius=1.0\n[vortex_particle]\nmoving=true\ntransfer=\"kernel\"\n"),
        InputError);
    EXPECT_THROW(solver_of("[material]\nelasticity=0.01\nsurfactant=1e-6\n[[bubble]]\ncenter=[0,0,0]\nradius=1.0\n"),
                 InputError);
    EXPECT_THROW(solver_of("[[bubble]]\ncenter=[0,0,0]\nradius=1.0\n[[event]]\nkind=\"inflate\"\nfactor=1.1\n"),
                 InputError);
    EXPECT_THROW(solver_of("[[film]]\nshape=\"disk\"\n[[vortex]]\nprofile=\"taylor\"\nspeed=1.0\n"), InputError);
    const std::string film = "[[film]]\nshape=\"rectangle\"\nu=[1,0,0]\nv=[0,1,0]\n[resolution]\nedge_length=0.2\n";
    const auto stream = [&](const std::string& more, const std::string& velocity) {
        return solver_of(film + more + "[vortex_particle.stream]\nvelocity=" + velocity);
    };
    EXPECT_NO_THROW(stream("[vortex_particle]\nincompressible=true\n", "[1,0,0]"));
    EXPECT_THROW(stream("", "[1,0,0]"), InputError);
    EXPECT_THROW(stream("[vortex_particle]\nincompressible=true\n", "[1,0.3,0]"), InputError);
    EXPECT_THROW(stream("[vortex_particle]\nincompressible=true\n", "[0,0,1]"), InputError);
    EXPECT_THROW(stream("[vortex_particle]\nincompressible=true\nwalls=\"no_slip\"\n", "[1,0,0]"), InputError);
    EXPECT_THROW(stream("[material]\ngravity=[0,-9.81,0]\n[vortex_particle]\nincompressible=true\n", "[1,0,0]"),
                 InputError);
    EXPECT_THROW(
        solver_of(
            "[[bubble]]\ncenter=[0,0,0]\nradius=1.0\n[[solid]]\ncenter=[0,0,1]\nradius=0.3\nfree=true\nmass=1.0\n"),
        InputError);
    EXPECT_THROW(solver_of(film + "[[solid]]\nradius=0.1\nfree=true\n"), InputError);
    const auto says = [](const std::string& scene, const std::string& why) {
        try {
            solver_of(scene);
        } catch (const InputError& error) {
            return std::string(error.what()).find(why) != std::string::npos;
        }
        return false;
    };
    const std::string moving = "[vortex_particle]\nmoving=true\n";
    const std::string flying = "[[bubble]]\ncenter=[0,0,0]\nradius=1.0\nvelocity=[1,0,0]\n";
    EXPECT_TRUE(says(film + moving + "incompressible=true\n[vortex_particle.stream]\nvelocity=[1,0,0]\n",
                     "stream.velocity of films that move"));
    EXPECT_TRUE(says(film + "[[solid]]\nradius=0.1\nfree=true\nmass=1.0\n" + moving, "free = true on films that move"));
    EXPECT_TRUE(says(
        "[[bubble]]\ncenter=[0,0,0]\nradius=1.0\n[[event]]\nkind=\"puncture\"\ntime=0.1\ncenter=[0,0,1]\n" + moving,
        "\"puncture\" is for solver melp"));
    EXPECT_TRUE(says("[[bubble]]\ncenter=[0,0,0]\nradius=1.0\n[[event]]\nkind=\"spot\"\nradius=0.1\n" + moving,
                     "\"spot\" is for solver melp"));
    EXPECT_TRUE(says(flying + "[[solid]]\ncenter=[0,0,1]\nradius=0.3\n" + moving, "on bubbles with a velocity"));
    for (const char* wrong : {"period=1.0", "stride=[1,0,0]", "mass=1.0", "free=true\nend=1.0"})
        EXPECT_THROW(solver_of(film + "[[solid]]\nradius=0.1\n" + wrong), InputError) << wrong;
    auto hole = solver_of("[[film]]\nshape=\"disk\"\n[[vortex]]\nprofile=\"hole\"\ncirculation=1.0\n");
    EXPECT_THROW(hole->start({}), InputError);
}

}  // namespace
}  // namespace lamella::vortex_particle
