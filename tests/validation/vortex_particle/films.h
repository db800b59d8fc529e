#pragma once

// Solvers from the text of a scene, and points that follow the centers of their vortices.

#include "lamella/core/error.h"
#include "lamella/scene/scene.h"
#include "lamella/solvers/vortex_particle/trace.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace lamella::vortex_particle {

inline std::unique_ptr<VortexParticleSolver> solver_of(const std::string& tables,
                                                       const std::vector<std::string>& overrides = {}) {
    const sim::SolverRegistry registry = scene::all_solvers();
    const scene::Scene scene =
        scene::parse_scene("solver = \"vortex_particle\"\n" + tables, "test.toml", overrides, registry);
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

/// The spot of a flat film at a point.
inline Spot spot_at(const Surface& s, const Vec3& x) {
    constexpr std::array<double, 3> kMiddle{1.0 / 3, 1.0 / 3, 1.0 / 3};
    Spot spot{0, kMiddle};
    for (std::uint32_t t = 0; t < s.triangles(); ++t)
        if (norm(s.point(t, kMiddle) - x) < norm(s.point(spot.triangle, kMiddle) - x)) spot.triangle = t;
    walk(s, spot, x - s.point(spot.triangle, kMiddle));
    return spot;
}

/// The value of a field of vertices at a point of a flat film.
inline double value_at(const Surface& s, const std::vector<double>& field, const Vec3& x) {
    const Spot spot = spot_at(s, x);
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) sum += spot.place[k] * field[s.corner[spot.triangle][k]];
    return sum;
}

/// Centers of vortices of a flat film: the mean position of vorticity of their sign within `radius` of where they were.
class Centers {
public:
    Centers(const VortexParticleSolver& solver, std::vector<Vec3> at, std::vector<double> sign, double radius)
        : solver_(solver), at_(std::move(at)), sign_(std::move(sign)), radius_(radius) {}

    /// To be called after each step; a center must not have moved by as much as the radius.
    void follow() {
        const Surface& s = solver_.surface();
        for (std::size_t k = 0; k < at_.size(); ++k) {
            Vec3 sum;
            double weight = 0.0;
            for (std::size_t v = 0; v < s.vertices(); ++v) {
                if (norm(s.position[v] - at_[k]) >= radius_) continue;
                const double w = std::max(0.0, sign_[k] * solver_.observed().circulation[v]);
                sum += w * s.position[v];
                weight += w;
            }
            at_[k] = sum / weight;
        }
    }
    const Vec3& operator[](std::size_t k) const { return at_[k]; }

private:
    const VortexParticleSolver& solver_;
    std::vector<Vec3> at_;
    std::vector<double> sign_;
    double radius_;
};

}  // namespace lamella::vortex_particle
