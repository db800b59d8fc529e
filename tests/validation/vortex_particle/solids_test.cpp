// Solids in a film.

#include "lamella/solvers/vortex_particle/solids.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "films.h"
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

/// A stick that starts suddenly makes the flow of a dipole around it, u = U a^2 / r^2 (2 (e . n) n - e), n = r / |r|,
/// before anything is shed; the walls are ten radii away and change it by a hundredth.
TEST(Stick, StartsWithPotentialFlowAroundIt) {
    std::vector<double> error;
    for (const double edge : {0.1, 0.05}) {
        auto solver = solver_of(fmt::format(R"(
[[film]]
shape = "rectangle"
center = [-4, -4, 0]
u = [8, 0, 0]
v = [0, 8, 0]
[[solid]]
radius = 0.4
velocity = [1, 0, 0]
[resolution]
edge_length = {}
[vortex_particle]
incompressible = true
largest_step = 0.001
)",
                                            edge));
        solver->start({});
        run_until(*solver, 0.002);
        const Surface& s = solver->surface();
        const MeshFlow& flow = solver->observed();
        double square = 0.0, size = 0.0, inside = 0.0;
        for (std::size_t t = 0; t < s.triangles(); ++t) {
            const Vec3 x = s.point(t, {1.0 / 3, 1.0 / 3, 1.0 / 3}) - Vec3{{0.002, 0, 0}};
            const double r = norm(x);
            if (r < 0.4 - edge) inside = std::max(inside, norm(flow.velocity[t] - Vec3{{1, 0, 0}}));
            if (r < 0.6 || r > 1.0) continue;
            const Vec3 exact = 0.16 / (r * r) * (2.0 * x[0] / (r * r) * x - Vec3{{1, 0, 0}});
            square += s.area[t] * squared_norm(flow.velocity[t] - exact);
            size += s.area[t] * squared_norm(exact);
        }
        EXPECT_LT(inside, 0.1);  // of the stick's speed, where it covers the film in part too
        error.push_back(std::sqrt(square / size));
    }
    // It acts as one that is larger by a third of an edge: first order.
    EXPECT_LT(error[1], 0.11);
    EXPECT_GT(std::log2(error[0] / error[1]), 0.9);
}

TEST(Stick, ShedsAsMuchCirculationAsItKeeps) {
    auto solver = solver_of(R"(
[material]
kinematic_viscosity = 1e-3
[[film]]
shape = "rectangle"
center = [-2, -1, 0]
u = [4, 0, 0]
v = [0, 2, 0]
[[solid]]
center = [-1.2, 0.01, 0]
radius = 0.15
velocity = [1, 0, 0]
spin = [0, 0, 1]
end = 1.5
[resolution]
edge_length = 0.0625
)");
    solver->start({});
    run_until(*solver, 2.0);
    const auto& circulation = solver->particles().circulation;
    double size = 0.0;
    for (const double c : circulation) size += std::abs(c);
    EXPECT_GT(size, 0.3);  // two vortices of about U times the diameter
    EXPECT_LT(std::abs(std::accumulate(circulation.begin(), circulation.end(), 0.0)), 1e-11 * size);
    // It stands still now, and so does the film that it covers.
    for (std::size_t t = 0; t < solver->surface().triangles(); ++t) {
        const Vec3 x = solver->surface().point(t, {1.0 / 3, 1.0 / 3, 1.0 / 3}) - Vec3{{0.3, 0.01, 0.0}};
        if (norm(x) >= 0.15 - 1.2 * 0.0625) continue;  // not covered as a whole
        EXPECT_LT(norm(solver->observed().velocity[t]), 0.1);
    }
}

constexpr double kFilmMass = 1000.0 * 4e-7;  // per area [kg/m^2]
constexpr double kPi = 3.14159265358979323846;

/// A disk of radius 0.4 m in a film at rest, ten radii from its walls.
std::unique_ptr<VortexParticleSolver> disk_in_still_film(double edge,
                                                         const std::string& solid,
                                                         const std::string& vortex = "") {
    return solver_of(fmt::format(R"(
[material]
kinematic_viscosity = 0.0
[[film]]
shape = "rectangle"
center = [-4, -4, 0]
u = [8, 0, 0]
v = [0, 8, 0]
[[solid]]
radius = 0.4
{}
{}
[resolution]
edge_length = {}
[vortex_particle]
incompressible = true
particles_per_triangle = 3
largest_step = 0.001
)",
                                 solid, vortex, edge));
}

/// The film that a disk covers, and as much again that has to get around it, take up the momentum 2 pi a^2 rho eta U.
TEST(Stick, FeelsTheAddedMassOfTheFilmWhenItStarts) {
    auto solver = disk_in_still_film(0.1, "velocity = [1, 0.5, 0]\nspin = [0, 0, 2]");
    solver->start({});
    solver->advance(0.001);
    const Vec3 impulse = 0.001 * solver->bodies()[0].force;
    const double exact = 2.0 * kPi * 0.16 * kFilmMass;
    EXPECT_NEAR(impulse[0] / exact, -1.0, 0.05);
    EXPECT_NEAR(impulse[1] / exact, -0.5, 0.025);
    // Turning moves only the film that it covers: half its mass times a^2 times the spin.
    EXPECT_NEAR(0.001 * solver->bodies()[0].torque[2] / (0.5 * kPi * 0.0256 * kFilmMass * 2.0), -1.0, 0.15);
}

TEST(FreeDisk, SharesItsMomentumWithTheFilmAroundIt) {
    const double film = 2.0 * kPi * 0.16 * kFilmMass;
    for (const double mass : {3.0 * film, 30.0 * film}) {
        auto solver = disk_in_still_film(0.1, fmt::format("velocity = [1, 0, 0]\nfree = true\nmass = {}", mass));
        solver->start({});
        solver->advance(0.001);
        EXPECT_NEAR(solver->bodies()[0].velocity[0] / (mass / (mass + film)), 1.0, 0.03) << mass;
        EXPECT_NEAR(solver->bodies()[0].velocity[1], 0.0, 1e-3) << mass;
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
