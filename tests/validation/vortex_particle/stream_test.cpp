// Film that streams through its frame.

#include <gtest/gtest.h>

#include "films.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

constexpr const char* kStream = R"(
[material]
kinematic_viscosity = 0.0
[[film]]
shape = "rectangle"
center = [0, -1, 0]
u = [4, 0, 0]
v = [0, 2, 0]
[resolution]
edge_length = 0.125
[vortex_particle]
incompressible = true
largest_step = 0.05
[vortex_particle.stream]
velocity = [1, 0, 0]
)";

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

double farthest_from_stream(const VortexParticleSolver& solver) {
    double worst = 0.0;
    for (const Vec3& u : solver.observed().velocity) worst = std::max(worst, norm(u - Vec3{{1, 0, 0}}));
    return worst;
}

TEST(Stream, StaysEvenAndKeepsAccountOfItsLiquid) {
    auto solver = solver_of(kStream);
    solver->start({});
    const double liquid = sum(solver->particles().volume);
    const auto count = static_cast<double>(solver->particles().size());
    run_until(*solver, 6.0);  // once and a half through
    EXPECT_LT(farthest_from_stream(*solver), 1e-12);
    double worst = 0.0;
    for (const double h : solver->observed().thickness) worst = std::max(worst, std::abs(h / 4e-7 - 1.0));
    EXPECT_LT(worst, 1e-12);
    const double in = scalar(*solver, "liquid_in"), out = scalar(*solver, "liquid_out");
    EXPECT_NEAR(in / (6.0 * 2.0 * 4e-7), 1.0, 1e-12);  // time times speed times width times thickness
    EXPECT_NEAR((liquid + in - out) / sum(solver->particles().volume), 1.0, 1e-12);
    EXPECT_NEAR(sum(solver->particles().volume) / liquid, 1.0, 0.02);
    EXPECT_NEAR(static_cast<double>(solver->particles().size()) / count, 1.0, 0.05);
}

TEST(Stream, TakesAVortexAlongAndOut) {
    const std::string vortex = "[[vortex]]\nprofile = \"taylor\"\ncenter = [1.5, 0.1, 0]\nradius = 0.25\nspeed = 0.3\n";
    auto solver = solver_of(kStream + vortex);
    solver->start({});
    const double strong = farthest_from_stream(*solver);
    run_until(*solver, 1.0);
    // By 1 m: its own motion is that of its images, which a vortex without circulation does not have.
    const auto& s = solver->surface();
    Vec3 center;
    double weight = 0.0;
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        const double w = std::max(0.0, solver->observed().circulation[v]);
        center += w * s.position[v];
        weight += w;
    }
    center *= 1.0 / weight;
    EXPECT_NEAR(center[0], 2.5, 0.02);
    EXPECT_NEAR(center[1], 0.1, 0.02);
    run_until(*solver, 5.0);
    EXPECT_LT(farthest_from_stream(*solver), 0.02 * strong);
}

}  // namespace
}  // namespace lamella::vortex_particle
