#pragma once

// Solvers from the text of a scene, and points that follow their flow.

#include "lamella/core/error.h"
#include "lamella/scene/scene.h"
#include "lamella/solvers/vortex_particle/trace.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

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

/// The spot of the surface that is nearest to a point, among the middles of the triangles.
inline Spot spot_near(const Surface& s, const Vec3& x) {
    constexpr std::array<double, 3> kMiddle{1.0 / 3, 1.0 / 3, 1.0 / 3};
    Spot best{0, kMiddle};
    for (std::uint32_t t = 0; t < s.triangles(); ++t)
        if (norm(s.point(t, kMiddle) - x) < norm(s.point(best.triangle, kMiddle) - x)) best.triangle = t;
    walk(s, best, x - s.point(best.triangle, kMiddle));
    return best;
}

/// Points that follow the flow of a solver, as centers of vortices do.
class Tracers {
public:
    Tracers(const VortexParticleSolver& solver, const std::vector<Vec3>& at, double radius) : solver_(solver), radius_(radius) {
        Particles::for_each_column(points_, [&](const char*, auto& column) { column.resize(at.size()); });
        for (std::size_t k = 0; k < at.size(); ++k) {
            const Spot spot = spot_near(solver.surface(), at[k]);
            points_.triangle[k] = spot.triangle;
            points_.place[k] = spot.place;
        }
        last_ = velocity();
    }
    /// One step of the solver, which must not change it by more than its own rules: then the tracers'.
    void advance(VortexParticleSolver& solver, double limit) {
        const double before = solver.time();
        solver.advance(limit);
        const std::vector<Vec3> now = velocity();
        std::vector<Vec3> middle(now.size());
        for (std::size_t v = 0; v < now.size(); ++v) middle[v] = 0.5 * (now[v] + last_[v]);
        trace(solver.surface(), middle, solver.time() - before, points_);
        last_ = now;
        const Surface& s = solver.surface();
        for (std::size_t k = 0; k < points_.size(); ++k) {
            Vec3 sum;
            double weight = 0.0;
            const double sign = solver.observed().circulation[s.corner[points_.triangle[k]][0]] > 0 ? 1 : -1;
            for (std::size_t v = 0; v < s.vertices(); ++v)
                if (norm(s.position[v] - at(k)) < radius_) {
                    const double w = std::max(0.0, sign * solver.observed().circulation[v]);
                    sum += w * s.position[v];
                    weight += w;
                }
            if (weight == 0.0) continue;
            Spot spot{points_.triangle[k], points_.place[k]};
            walk(s, spot, sum / weight - at(k));
            points_.triangle[k] = spot.triangle;
            points_.place[k] = spot.place;
        }
    }
    Vec3 at(std::size_t k) const { return solver_.surface().point(points_.triangle[k], points_.place[k]); }

private:
    std::vector<Vec3> velocity() const { return vertex_velocity(solver_.surface(), solver_.observed().velocity); }

    const VortexParticleSolver& solver_;
    double radius_;
    Particles points_;
    std::vector<Vec3> last_;
};

}  // namespace lamella::vortex_particle
