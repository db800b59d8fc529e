// Bubbles that swing: frequencies with the inertia of the film, of its liquid, and of the air.

#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/volume.h"

#include <gtest/gtest.h>

#include "films.h"
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

constexpr double kPi = 3.14159265358979323846, kRadius = 0.05, kTension = 0.025, kDensity = 1000.0, kAir = 1.2;

double legendre(int l, double z) { return l == 2 ? 0.5 * (3 * z * z - 1) : 0.5 * z * (5 * z * z - 3); }

/// A bubble of 5 cm, stretched along z by `amplitude` of the mode l.
std::unique_ptr<VortexParticleSolver> swinging(
    int l, double amplitude, double edge, double step, const film::Material& material, Options options) {
    auto films = std::make_shared<film::Problem>();
    films->material = material;
    films->edge_length = edge;
    films->mesh = mesh::spheres({{Vec3{}, kRadius}}, edge);
    for (Vec3& x : films->mesh.position) x *= 1.0 + amplitude * legendre(l, x[2] / norm(x));
    const auto volume = mesh::region_volumes(films->mesh);
    for (const auto r : films->mesh.regions.ids())
        if (films->mesh.regions[r].kind == mesh::RegionKind::kClosed) films->mesh.regions[r].target_volume = volume[r];
    options.moving = true;
    options.largest_step = step;
    sim::SolverInput input;
    input.films = films;
    auto solver = std::make_unique<VortexParticleSolver>(options, input);
    solver->start({});
    return solver;
}

double mode(const VortexParticleSolver& solver, int l) {
    const Surface& s = solver.surface();
    double sum = 0.0, weight = 0.0;
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        const double p = legendre(l, s.position[v][2] / norm(s.position[v]));
        sum += s.vertex_area[v] * p * (norm(s.position[v]) / kRadius - 1.0);
        weight += s.vertex_area[v] * p * p;
    }
    return sum / weight;
}

struct Swing {
    double omega, kept, energy, volume;
};
/// Four zeros of the mode: one period and a half; how much of it is left, and of all energies.
Swing swing_of(VortexParticleSolver& solver, int l) {
    std::vector<double> zeros;
    const double first = mode(solver, l), energy = scalar(solver, "energy");
    double before = first, largest = 0.0, drift = 0.0, volume = 0.0;
    while (zeros.size() < 5) {
        const double t = solver.time();
        solver.advance(t + 1.0);
        const double now = mode(solver, l);
        if ((now > 0.0) != (before > 0.0)) zeros.push_back(t + (solver.time() - t) * before / (before - now));
        if (zeros.size() == 3) largest = std::max(largest, std::abs(now));
        before = now;
        drift = std::max(drift, std::abs(scalar(solver, "energy") - energy));
        volume = std::max(volume, scalar(solver, "volume_error"));
    }
    return {4.0 * kPi / (zeros[4] - zeros[0]), largest / std::abs(first), drift, volume};
}

film::Material water(double thickness) {
    film::Material material;
    material.surface_tension = kTension;
    material.thickness = thickness;
    material.air_density = kAir;
    material.kinematic_viscosity = 0.0;
    return material;
}

/// Of the mode at the start, per amplitude squared: sigma (l - 1) (l + 2) 4 pi / (2 l + 1) R^2.
double frequency_energy(int l) {
    return kTension * (l - 1) * (l + 2) * 4.0 * kPi / (2 * l + 1) * kRadius * kRadius * 0.002 * 0.002;
}

/// omega^2 = 2 sigma (l - 1) (l + 2) / (R^2 m), m the inertia per area: "oscillation/film_only/eta=5e-07" of the
/// reference values without air, "oscillation/film+air/eta=5e-07" with it.
double frequency(int l, double inertia) { return std::sqrt(2.0 * kTension * (l - 1) * (l + 2) / inertia) / kRadius; }

constexpr double kThickness = 5e-7, kAmplitude = 0.002;  // small: at 0.02 it swings slower by 0.5 %

TEST(SwingingBubble, HasTheFrequencyOfItsFilm) {
    for (const auto& [l, reference] : {std::pair{2, 400.0}, std::pair{3, 632.4555320336758}}) {
        EXPECT_NEAR(frequency(l, kDensity * kThickness) / reference, 1.0, 1e-12);
        std::vector<double> error;
        for (const double edge : {0.01, 0.005}) {
            Options options;
            options.incompressible = true;
            auto solver = swinging(l, kAmplitude, edge, 0.05 / reference, water(kThickness), options);
            const double energy_of_mode = frequency_energy(l);
            const Swing s = swing_of(*solver, l);
            error.push_back(std::abs(s.omega / reference - 1.0));
            EXPECT_NEAR(s.kept, 1.0, 5e-3) << l << " " << edge;
            EXPECT_LT(s.energy, 5e-3 * energy_of_mode) << l << " " << edge;
            EXPECT_LT(s.volume, 1e-10);
        }
        EXPECT_LT(error[0], 0.012) << l;  // of an edge of a fifth of the radius
        EXPECT_LT(error[1], 0.005) << l;
        EXPECT_LT(error[1], 0.6 * error[0]) << l;  // second order, and what the time step leaves
    }
}

TEST(SwingingBubble, HasTheFrequencyOfFilmAndAir) {
    for (const auto& [l, reference] : {std::pair{2, 39.80148760839956}, std::pair{3, 75.05866250408016}}) {
        EXPECT_NEAR(frequency(l, kDensity * kThickness + kAir * kRadius * (1.0 / l + 1.0 / (l + 1))) / reference, 1.0,
                    1e-12);
        Options options;
        options.incompressible = true;
        options.motion.added_air = true;
        auto solver = swinging(l, kAmplitude, 0.006, 0.05 / reference, water(kThickness), options);
        const Swing s = swing_of(*solver, l);
        EXPECT_NEAR(s.omega / reference, 1.0, 0.01) << l;
        EXPECT_NEAR(s.kept, 1.0, 5e-3) << l;
        EXPECT_LT(s.energy, 1e-2 * frequency_energy(l)) << l;
    }
}

/// Where surfactant resists stretch, liquid runs along the film that moves along its normal. With Lambda = l (l + 1) /
/// R^2 and the frequency w of the film alone, the modes of both have
///
///     x^2 - x (w^2 + Lambda c^2 + (2 / R)^2 c^2) + w^2 Lambda c^2 = 0,   x = omega^2
TEST(SwingingBubble, DragsItsLiquidAlong) {
    constexpr double kWave = 20.0;
    const int l = 2;
    const double w = frequency(l, kDensity * kThickness), c2 = kWave * kWave,
                 around = l * (l + 1) / (kRadius * kRadius);
    const double sum = w * w + around * c2 + 4.0 * c2 / (kRadius * kRadius);
    const double exact = std::sqrt(0.5 * (sum - std::sqrt(sum * sum - 4.0 * w * w * around * c2)));
    EXPECT_LT(exact / w, 0.77);
    film::Material material = water(kThickness);
    material.elastic_wave_speed = kWave;
    auto solver = swinging(l, kAmplitude, 0.01, 0.02 / exact, material, Options{});
    const Swing s = swing_of(*solver, l);
    EXPECT_NEAR(s.omega / exact, 1.0, 0.01);
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }
double size(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0, [](double a, double b) { return a + std::abs(b); });
}

constexpr const char* kDeforming = R"(
[material]
gravity = [0.0, 0.0, -9.81]
[[bubble]]
center = [0.0, 0.0, 0.0]
radius = 0.1
[[vortex]]
center = [0.1, 0.0, 0.0]
radius = 0.04
circulation = 0.05
[resolution]
edge_length = 0.02
[vortex_particle]
moving = true
[vortex_particle.noise]
thickness = 0.3
surfactant = 0.2
shape = 0.04
frequency = 15.0
[vortex_particle.motion]
added_air = true
)";

TEST(DeformingBubble, KeepsLiquidSurfactantAndCirculationAsItsTrianglesChange) {
    auto solver = solver_of(kDeforming);
    solver->start({});
    const double liquid = sum(solver->particles().volume), soap = sum(solver->particles().amount);
    int remeshed = 0;
    for (std::size_t faces = solver->films().faces.size(); solver->time() < 0.3; faces = solver->films().faces.size()) {
        solver->advance(0.3);
        remeshed += faces != solver->films().faces.size() ? 1 : 0;
        ASSERT_LT(scalar(*solver, "volume_error"), 1e-3);
    }
    EXPECT_GT(remeshed, 2);
    EXPECT_NEAR(sum(solver->particles().volume) / liquid, 1.0, 1e-12);
    EXPECT_NEAR(sum(solver->particles().amount) / soap, 1.0, 1e-12);
    EXPECT_LT(std::abs(sum(solver->particles().circulation)), 1e-11 * size(solver->particles().circulation));
    EXPECT_NEAR(sum(solver->particles().area) / solver->surface().total_area, 1.0, 0.05);
}

constexpr const char* kPopping = R"(
[material]
gravity = [0.0, 0.0, -9.81]
[[film]]
shape = "double_bubble"
volume = 1e-3
[[vortex]]
center = [0.06, 0.0, 0.02]
radius = 0.03
circulation = 0.02
[resolution]
edge_length = 0.016
[[event]]
kind = "pop"
time = 0.05
region = 1
into = 2
[vortex_particle]
moving = true
[vortex_particle.noise]
thickness = 0.2
)";

TEST(DoubleBubble, RunsThroughAPopWithoutLosingLiquid) {
    auto solver = solver_of(kPopping);
    solver->start({});
    const double liquid = sum(solver->particles().volume), soap = sum(solver->particles().amount);
    std::vector<std::string> kinds;
    double swirl = 0.0;
    while (solver->time() < 0.1) {
        solver->advance(0.1);
        for (const sim::Event& event : solver->take_events()) kinds.push_back(event.kind);
        swirl = std::max(swirl, size(solver->particles().circulation));
    }
    EXPECT_EQ(std::count(kinds.begin(), kinds.end(), "pop"), 1);
    EXPECT_EQ(solver->surface().components, 1U);
    EXPECT_NEAR(sum(solver->particles().volume) / liquid, 1.0, 1e-12);
    EXPECT_NEAR(sum(solver->particles().amount) / soap, 1.0, 1e-12);
    EXPECT_LT(std::abs(sum(solver->particles().circulation)), 1e-11 * swirl);
    EXPECT_LT(scalar(*solver, "max_velocity"), 20.0);
}

/// The lower half takes up what the upper one was, from its border, and no faster than its waves run.
TEST(HalfBubble, TakesUpTheOtherHalfWhenThatBursts) {
    auto solver = solver_of(R"(
[[film]]
shape = "ball_in_ring"
radius = 0.1
[[event]]
time = 0.0
region = 1
into = 0
[resolution]
edge_length = 0.015
[vortex_particle]
moving = true
air_drag = 0.5
[vortex_particle.motion]
added_air = true
damping = 1.0
)");
    solver->start({});
    const double liquid = sum(solver->particles().volume);
    EXPECT_NEAR(scalar(*solver, "mesh_volume_error"), -0.5, 0.02);  // in the border
    double fastest = 0.0;
    while (solver->time() < 1.0) {
        solver->advance(1.0);
        fastest = std::max(fastest, scalar(*solver, "max_mach"));
    }
    EXPECT_LT(fastest, 0.6);
    EXPECT_NEAR(scalar(*solver, "mesh_volume_error"), 0.0, 0.1);
    EXPECT_NEAR(sum(solver->particles().volume) / liquid, 1.0, 1e-12);
}

}  // namespace
}  // namespace lamella::vortex_particle
