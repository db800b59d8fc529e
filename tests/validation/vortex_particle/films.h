#pragma once

// Solvers from the text of a scene.

#include "lamella/scene/scene.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include <memory>
#include <string>
#include <vector>

namespace lamella::vortex_particle {

inline std::unique_ptr<VortexParticleSolver> solver_of(const std::string& tables, const std::vector<std::string>& overrides = {}) {
    const sim::SolverRegistry registry = scene::all_solvers();
    const scene::Scene scene = scene::parse_scene("solver = \"vortex_particle\"\n" + tables, "test.toml", overrides, registry);
    std::unique_ptr<sim::Solver> solver = scene::create_solver(scene, registry);
    return std::unique_ptr<VortexParticleSolver>(dynamic_cast<VortexParticleSolver*>(solver.release()));
}

inline void run_until(VortexParticleSolver& solver, double time) {
    while (solver.time() < time) solver.advance(time);
}

inline double scalar(const VortexParticleSolver& solver, const std::string& name) {
    for (const sim::Scalar& s : solver.scalars())
        if (s.name == name) return s.value;
    throw InputError("no scalar " + name);
}

/// The largest value at the vertices within `radius` of a point, and where it is.
inline Vec3 peak_near(const VortexParticleSolver& solver, const std::vector<double>& value, const Vec3& at, double radius) {
    const Surface& s = solver.surface();
    Vec3 best = at;
    double most = -1e300;
    for (std::size_t v = 0; v < s.vertices(); ++v)
        if (norm(s.position[v] - at) < radius && value[v] > most) {
            most = value[v];
            best = s.position[v];
        }
    return best;
}

}  // namespace lamella::vortex_particle
