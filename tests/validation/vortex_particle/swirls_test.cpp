// Vortices in a film that keeps its thickness: Taylor's pair, leapfrogging pairs, a wave on a sphere.

#include "films.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace lamella::vortex_particle {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::string taylor(double distance, int cells) {
    return fmt::format(R"(
[material]
kinematic_viscosity = 0.0
[[film]]
shape = "rectangle"
center = [{0}, {0}, 0]
u = [{1}, 0, 0]
v = [0, {1}, 0]
[[vortex]]
profile = "taylor"
center = [{2}, 0, 0]
radius = 0.3
speed = 1.0
[[vortex]]
profile = "taylor"
center = [{3}, 0, 0]
radius = 0.3
speed = 1.0
[resolution]
edge_length = {4}
[vortex_particle]
incompressible = true
)", -kPi, 2 * kPi, -0.5 * distance, 0.5 * distance, 2 * kPi / cells);
}

TEST(TaylorVortices, PartFromADistanceOf081AndMergeFrom06) {
    for (const double distance : {0.81, 0.60}) {
        auto solver = solver_of(taylor(distance, 64));
        solver->start({});
        const double energy = solver->kinetic_energy();
        Tracers tracers(*solver, {{{-0.5 * distance, 0, 0}}, {{0.5 * distance, 0, 0}}}, 0.25);
        double worst = 0.0;
        while (solver->time() < 8.0) {
            tracers.advance(*solver, std::floor(solver->time() / 0.5 + 1.0 + 1e-9) * 0.5);
            if (std::abs(solver->time() / 0.5 - std::round(solver->time() / 0.5)) < 1e-9) printf("%g: %g  dKE %g\n", solver->time(), norm(tracers.at(0) - tracers.at(1)), solver->kinetic_energy() / energy - 1.0);
            worst = std::max(worst, std::abs(solver->kinetic_energy() / energy - 1.0));
        }
        const double end = norm(tracers.at(0) - tracers.at(1));
        if (distance > 0.7) EXPECT_GT(end, 1.5);
        else EXPECT_LT(end, 0.8);
        EXPECT_LT(worst, 0.01);
    }
}

constexpr const char* kLeapfrog = R"(
[material]
kinematic_viscosity = 0.0
[[film]]
shape = "rectangle"
center = [-2, -1, 0]
u = [4, 0, 0]
v = [0, 2, 0]
[[vortex]]
center = [-1.5, 0.6, 0]
radius = 0.08
circulation = 1.0
[[vortex]]
center = [-1.5, 0.2, 0]
radius = 0.08
circulation = 1.0
[[vortex]]
center = [-1.5, -0.2, 0]
radius = 0.08
circulation = -1.0
[[vortex]]
center = [-1.5, -0.6, 0]
radius = 0.08
circulation = -1.0
[resolution]
edge_length = 0.03125
[vortex_particle]
incompressible = true
)";

TEST(Leapfrog, SwapsPlaces) {
    std::vector<std::string> o; if (getenv("DT")) o.push_back(std::string("vortex_particle.largest_step=") + getenv("DT"));
    if (getenv("OPT")) o.push_back(getenv("OPT"));
    auto solver = solver_of(kLeapfrog, o);
    solver->start({});
    const double energy = solver->kinetic_energy();
    Tracers tracers(*solver, {{{-1.5, 0.6, 0}}, {{-1.5, 0.2, 0}}, {{-1.5, -0.2, 0}}, {{-1.5, -0.6, 0}}}, 0.12);
    double ahead = 0.0;
    while (solver->time() < 9.0) {
        tracers.advance(*solver, std::floor(solver->time() / 0.5 + 1.0 + 1e-9) * 0.5);
        const double now = tracers.at(1)[0] - tracers.at(0)[0];
        if ((now > 0) != (ahead > 0)) printf("swap at %g  x %g\n", solver->time(), tracers.at(0)[0]);
        ahead = now;
        if (std::abs(solver->time() / 0.5 - std::round(solver->time() / 0.5)) < 1e-9)
            printf("%g: %g %g  %g %g dKE %g\n", solver->time(), tracers.at(0)[0], tracers.at(0)[1], tracers.at(1)[0], tracers.at(1)[1], solver->kinetic_energy() / energy - 1.0);
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
