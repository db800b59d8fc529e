// Waves: of thickness in a flat film, of vorticity on a sphere; rotations; the core of a vortex.

#include "lamella/mesh/shapes/sphere.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "films.h"
#include <cmath>
#include <complex>

namespace lamella::vortex_particle {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Psi of Lap Psi = omega for omega = x z on the unit sphere, l = 2: Psi = -omega / 6 [method sheet 12.5].
TEST(SpherePoisson, ConvergesWithTheSquareOfTheEdge) {
    std::vector<double> stream_error, velocity_error, vertex_error;
    for (const double edge : {0.3, 0.15, 0.075}) {
        const Surface s = surface_of(mesh::spheres({{Vec3{}, 1.0}}, edge));
        std::vector<double> omega(s.vertices()), none;
        for (std::size_t v = 0; v < s.vertices(); ++v)
            omega[v] = s.vertex_area[v] * s.position[v][0] * s.position[v][2];
        const std::vector<double> psi = FlowSolver(s).stream_function(s, omega, none);
        double mean = 0.0, square = 0.0, norm2 = 0.0;
        for (std::size_t v = 0; v < s.vertices(); ++v) mean += s.vertex_area[v] * psi[v] / s.total_area;
        for (std::size_t v = 0; v < s.vertices(); ++v) {
            const double exact = -s.position[v][0] * s.position[v][2] / 6.0;
            square += s.vertex_area[v] * std::pow(psi[v] - mean - exact, 2);
            norm2 += s.vertex_area[v] * exact * exact;
        }
        stream_error.push_back(std::sqrt(square / norm2));
        const auto exact_velocity = [](const Vec3& at) {  // n x grad Psi
            const Vec3 n = at / norm(at), g = {{-n[2] / 6.0, 0.0, -n[0] / 6.0}};
            return cross(n, g);
        };
        const std::vector<Vec3> u = rotated_gradient(s, psi), w = vertex_velocity(s, u);
        double in_triangles = 0.0, at_vertices = 0.0, size = 0.0;
        for (std::size_t t = 0; t < s.triangles(); ++t) {
            const Vec3 exact = exact_velocity(s.point(t, {1.0 / 3, 1.0 / 3, 1.0 / 3}));
            in_triangles += s.area[t] * squared_norm(u[t] - exact);
            size += s.area[t] * squared_norm(exact);
        }
        for (std::size_t v = 0; v < s.vertices(); ++v)
            at_vertices += s.vertex_area[v] * squared_norm(w[v] - exact_velocity(s.position[v]));
        velocity_error.push_back(std::sqrt(in_triangles / size));
        vertex_error.push_back(std::sqrt(at_vertices / size));
    }
    const auto order = [](const std::vector<double>& error) { return 0.5 * std::log2(error[0] / error[2]); };
    EXPECT_GT(order(stream_error), 1.95);
    EXPECT_LT(stream_error[2], 1.5e-3);
    EXPECT_GT(order(velocity_error), 0.95);
    // Second order but at the twelve vertices with five triangles, which are ever fewer of all.
    EXPECT_GT(order(vertex_error), 1.7);
    EXPECT_LT(vertex_error[2], 4e-3);
}

std::string rossby_haurwitz(double edge, double step) {
    return fmt::format(R"(
[material]
kinematic_viscosity = 0.0
[[bubble]]
center = [0, 0, 0]
radius = 1.0
[[vortex]]
profile = "rotation"
rate = 1.0
[[vortex]]
profile = "rossby_haurwitz"
circulation = 0.3
[resolution]
edge_length = {}
[vortex_particle]
incompressible = true
largest_step = {}
)",
                       edge, step);
}

/// Size and phase of the wave that turns about z with three crests.
std::complex<double> wave(const VortexParticleSolver& solver) {
    const Surface& s = solver.surface();
    std::complex<double> sum;
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        const Vec3& x = s.position[v];
        sum += solver.observed().circulation[v] * x[2] * std::pow(std::complex<double>(x[0], -x[1]), 3);
    }
    return sum;
}

TEST(RossbyHaurwitzWave, TurnsAtNineTenthsOfTheRotation) {
    for (const double edge : {0.15, 0.075}) {
        auto solver = solver_of(rossby_haurwitz(edge, 0.02));
        solver->start({});
        const double energy = solver->kinetic_energy(), impulse = scalar(*solver, "angular_impulse_z");
        std::complex<double> before = wave(*solver);
        const double size = std::abs(before);
        double phase = 0.0;
        const double end = 2 * kPi / 0.9;  // one turn
        while (solver->time() < end) {
            solver->advance(end);
            const std::complex<double> now = wave(*solver);
            phase += std::arg(before / now) / 3.0;
            before = now;
        }
        EXPECT_NEAR(phase / end / 0.9, 1.0, 5e-4) << edge;
        EXPECT_NEAR(std::abs(before) / size, 1.0, 2e-3) << edge;
        EXPECT_NEAR(solver->kinetic_energy() / energy, 1.0, 3e-3) << edge;
        EXPECT_NEAR(scalar(*solver, "angular_impulse_z") / impulse, 1.0, 1e-3) << edge;
    }
}

TEST(RigidRotation, IsNotDampedBySurfaceViscosityButByThePublishedOne) {
    for (const char* form : {"surface", "laplace"}) {
        auto solver = solver_of(R"(
[material]
kinematic_viscosity = 0.01
[[bubble]]
center = [0, 0, 0]
radius = 1.0
[[vortex]]
profile = "rotation"
rate = 1.0
axis = [1, 2, 3]
[resolution]
edge_length = 0.15
[vortex_particle]
incompressible = true
)",
                                {std::string("vortex_particle.viscosity=") + form});
        solver->start({});
        const double energy = solver->kinetic_energy();
        run_until(*solver, 5.0);
        // Diffusion of omega, l = 1: the energy falls by exp(-2 l (l + 1) nu t / R^2).
        const double exact = std::string(form) == "laplace" ? std::exp(-2.0 * 2.0 * 0.01 * 5.0) : 1.0;
        EXPECT_NEAR(solver->kinetic_energy() / energy / exact, 1.0, 2e-3) << form;
    }
}

/// A film that turns as a whole in a ring that holds it comes to rest: its energy is
///
///     E / E_0 = 8 sum exp(-2 nu l_n^2 t / R^2) / l_n^2,   l_n the zeros of the Bessel function J_1
TEST(WallsWithoutSlip, StopARotationAsViscosityAsks) {
    constexpr double kZeros[] = {3.8317059702,  7.0155866698,  10.1734681351,
                                 13.3236919363, 16.4706300509, 19.6158585105};
    std::vector<double> error;
    for (const double edge : {0.1, 0.05}) {
        auto solver = solver_of(fmt::format(R"(
[material]
kinematic_viscosity = 0.05
[[film]]
shape = "disk"
radius = 1.0
[[vortex]]
profile = "rotation"
rate = 1.0
[resolution]
edge_length = {0}
[vortex_particle]
incompressible = true
walls = "no_slip"
largest_step = {1}
)",
                                            edge, 0.1 * edge));
        solver->start({});
        const double start = solver->kinetic_energy();
        double worst = 0.0;
        for (const double time : {0.25, 0.5, 1.0}) {
            run_until(*solver, time);
            double exact = 0.0;
            for (const double l : kZeros) exact += 8.0 * std::exp(-2.0 * 0.05 * l * l * time) / (l * l);
            worst = std::max(worst, std::abs(solver->kinetic_energy() / start / exact - 1.0));
        }
        error.push_back(worst);
    }
    EXPECT_LT(error[1], 0.006);
    EXPECT_GT(std::log2(error[0] / error[1]), 1.0);  // steps go down with edges: first order in time
}

/// eta = eta_0 (1 + eps cos k x) at rest swings with the frequency c k, damped by implicit steps at omega^2 dt / 2.
TEST(ElasticWave, HasTheFrequencyOfTheGibbsElasticity) {
    constexpr double kStep = 0.002, kOmega = 5.0 * kPi;
    std::vector<double> error;
    for (const double edge : {0.1, 0.05, 0.025}) {
        auto solver = solver_of(fmt::format(R"(
[material]
kinematic_viscosity = 0.0
elastic_wave_speed = 5.0
[[film]]
shape = "rectangle"
u = [1, 0, 0]
v = [0, 0.4, 0]
[resolution]
edge_length = {}
[vortex_particle]
largest_step = {}
[vortex_particle.start]
thickness = "cosine"
thickness_top = 4.04e-7
thickness_bottom = 3.96e-7
surfactant = "proportional"
up = [1, 0, 0]
)",
                                            edge, kStep));
        solver->start({});
        const Surface& s = solver->surface();
        const auto amplitude = [&] {
            double sum = 0.0;
            for (std::size_t v = 0; v < s.vertices(); ++v)
                sum += s.vertex_area[v] * (solver->observed().thickness[v] / 4e-7 - 1.0) *
                       std::cos(kPi * s.position[v][0]);
            return sum;
        };
        std::vector<double> zeros;
        double before = amplitude();
        const double first = before;
        double after_a_period = 0.0;
        while (zeros.size() < 4) {
            const double t = solver->time();
            solver->advance(10.0);
            const double now = amplitude();
            if ((now > 0.0) != (before > 0.0)) zeros.push_back(t + kStep * before / (before - now));
            before = now;
            if (std::abs(solver->time() - 2.0 * kPi / kOmega) < 0.5 * kStep) after_a_period = now / first;
        }
        error.push_back(std::abs(3.0 * kPi / (zeros[3] - zeros[0]) / kOmega - 1.0));
        const double exact = std::exp(-0.5 * kOmega * kOmega * kStep * 2.0 * kPi / kOmega);
        EXPECT_NEAR(after_a_period / exact, 1.0, 10.0 * edge * edge) << edge;
    }
    EXPECT_LT(error[1], 0.01);
    EXPECT_LT(error[2], 0.002);
    EXPECT_GT(0.5 * std::log2(error[0] / error[2]), 1.6);  // second order, and what the time step leaves
}

/// A Taylor vortex thins its core by (e / 2) Ma^2 where the liquid is as uniform as its surfactant [method sheet 5.10].
TEST(VortexCore, ThinsWithTheSquareOfTheMachNumber) {
    constexpr double kMach = 0.1;
    auto solver = solver_of(fmt::format(R"(
[material]
kinematic_viscosity = 0.0
elastic_wave_speed = {}
[[film]]
shape = "rectangle"
center = [-2, -2, 0]
u = [4, 0, 0]
v = [0, 4, 0]
[[vortex]]
profile = "taylor"
radius = 0.5
speed = 1.0
[resolution]
edge_length = 0.125
)",
                                        1.0 / kMach));
    solver->start({});
    run_until(*solver, 1.0);  // the waves of the sudden start run out in a box of 4 m: the mean over the next second
    double thinning = 0.0;
    constexpr int kLooks = 50;
    for (int k = 1; k <= kLooks; ++k) {
        run_until(*solver, 1.0 + static_cast<double>(k) / kLooks);
        const MeshFlow& flow = solver->observed();
        thinning += std::log(value_at(solver->surface(), flow.thickness, {{1.9, 0.1, 0.0}}) /
                             value_at(solver->surface(), flow.thickness, {})) /
                    kLooks;
    }
    EXPECT_NEAR(thinning / (0.5 * std::exp(1.0) * kMach * kMach), 1.0, 0.05);
}

/// A Taylor vortex whose core is 2.5 and 5 edges in radius grows as a^2 + 2 nu t; of its energy is left the square of
/// the ratio of the two areas.
TEST(ViscousFilm, FadesNarrowSwirlsAsItsViscositySays) {
    std::vector<double> error;
    for (const double edge : {0.08, 0.04}) {
        auto solver = solver_of(fmt::format(R"(
[material]
kinematic_viscosity = 0.01
[[film]]
shape = "rectangle"
center = [-1, -1, 0]
u = [2, 0, 0]
v = [0, 2, 0]
[[vortex]]
profile = "taylor"
radius = 0.2
speed = 1
[resolution]
edge_length = {}
[vortex_particle]
incompressible = true
particles_per_triangle = 4
largest_step = 0.02
)",
                                            edge));
        solver->start({});
        const double energy = solver->kinetic_energy();
        run_until(*solver, 1.0);
        error.push_back(solver->kinetic_energy() / energy / std::pow(0.04 / 0.06, 2) - 1.0);
    }
    EXPECT_LT(std::abs(error[0]), 0.025) << error[0];
    EXPECT_LT(std::abs(error[1]), 0.01) << error[1];
}

}  // namespace
}  // namespace lamella::vortex_particle
