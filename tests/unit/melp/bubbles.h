#pragma once

// Bubbles and films for the tests of melp.

#include "lamella/scene/scene.h"
#include "lamella/solvers/melp/melp_solver.h"

#include "../sim/state_memory.h"
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace lamella::melp {

inline constexpr double kRadius = 0.05;                                  // [m]
inline constexpr double kTension = 0.025;                                // of one interface [N/m]
inline constexpr double kFilmMass = 1000.0 * 5e-7;                       // [kg/m^2]
inline const double kWaveSpeed = std::sqrt(2.0 * kTension / kFilmMass);  // of the membrane [m/s]

/// Edge that gives so many coarse particles on a sphere of radius kRadius.
inline double edge_for(double coarse_particles) {
    return kRadius * std::sqrt(4.0 * std::numbers::pi / coarse_particles);
}

inline std::unique_ptr<MelpSolver> solver_of(const std::string& tables,
                                             const std::vector<std::string>& overrides = {}) {
    const auto registry = scene::all_solvers();
    const auto scene = scene::parse_scene("solver = \"melp\"\n" + tables, "test.toml", overrides, registry);
    auto solver = scene::create_solver(scene, registry);
    return std::unique_ptr<MelpSolver>(dynamic_cast<MelpSolver*>(solver.release()));
}

inline std::unique_ptr<MelpSolver> started(const std::string& tables) {
    auto solver = solver_of(tables);
    solver->start({});
    return solver;
}

/// Films of tension kTension and mass kFilmMass, 500 nm thick, started.
/// @param shape     tables [[bubble]], [[film]] and others   @param options  lines of [melp]
/// @param material  more lines of [material]
inline std::unique_ptr<MelpSolver> films(const std::string& shape,
                                         double edge_length,
                                         const std::string& options,
                                         const std::string& material = "") {
    auto solver =
        solver_of("[material]\nsurface_tension = " + std::to_string(kTension) +
                  "\nthickness = 5e-7\nliquid_density = 1000.0\nsurfactant = 1e-7\n" + material + "\n" + shape +
                  "\n[resolution]\nedge_length = " + std::to_string(edge_length) + "\n[melp]\n" + options);
    solver->start({});
    return solver;
}

/// One bubble of radius kRadius.
inline std::unique_ptr<MelpSolver> bubble(double coarse_particles,
                                          const std::string& options,
                                          const std::string& material = "") {
    return films("[[bubble]]\nradius = " + std::to_string(kRadius), edge_for(coarse_particles), options, material);
}

inline void advance(MelpSolver& solver, int steps) {
    for (int k = 0; k < steps; ++k) solver.advance(1e9);
}

/// @param time  [s]
inline void advance_to(MelpSolver& solver, double time) {
    while (solver.time() < time) solver.advance(time);
}

inline test::StateMemory state_of(const MelpSolver& solver) {
    test::StateMemory memory;
    solver.save(memory);
    return memory;
}

inline double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

inline double scalar(const sim::Solver& solver, const std::string& name) {
    for (const sim::Scalar& s : solver.scalars())
        if (s.name == name) return s.value;
    return std::nan("");
}

inline double legendre(int l, double c) {
    double before = 1.0, now = c;
    for (int k = 2; k <= l; ++k) {
        const double next = ((2 * k - 1) * c * now - (k - 1) * before) / k;
        before = now;
        now = next;
    }
    return l == 0 ? 1.0 : now;
}

/// Amplitude of a mode of the shape about the center of area: (2 l + 1) / (4 pi) times the integral of r P_l(x / r)
/// over the solid angle [m].
inline double shape_mode(const MelpSolver& solver, int l) {
    const auto& x = solver.coarse().position;
    Vec3 center;
    double area = 0.0, sum = 0.0, angle = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        center += solver.geometry().area[i] * x[i];
        area += solver.geometry().area[i];
    }
    center = center / area;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Vec3 d = x[i] - center;
        const double r = norm(d), solid = solver.geometry().area[i] * dot(solver.geometry().normal[i], d) / (r * r * r);
        sum += solid * r * legendre(l, d[0] / r);
        angle += solid;
    }
    return (2 * l + 1) * sum / angle;
}

/// Time of a swing of `value`, which vanishes at rest: over `crossings` crossings of zero after the first.
template <class Value>
double period(MelpSolver& solver, int crossings, Value&& value) {
    double before = value(), first = 0.0, last = 0.0;
    for (int seen = 0; seen <= crossings;) {
        const double time = solver.time();
        solver.advance(1e9);
        const double now = value();
        if (now * before < 0.0) {
            last = time + (solver.time() - time) * before / (before - now);
            if (seen++ == 0) first = last;
        }
        before = now;
    }
    return 2.0 * (last - first) / crossings;
}

}  // namespace lamella::melp
