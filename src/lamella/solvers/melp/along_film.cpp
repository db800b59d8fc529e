// What pulls films along themselves: weight, the air that drags, surfactant, warmth, borders of black film.

#include "lamella/solvers/melp/black_film.h"
#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/melp/operators.h"

#include <cmath>

namespace lamella::melp {

/// Of the air that drags [m/s].
Vec3 MelpSolver::wind_at(const Vec3& x) const {
    const Vec3 arm = x - options_.wind_center;
    const double square = options_.wind_radius * options_.wind_radius;
    const double fade = square > 0.0 ? std::exp(-squared_norm(arm) / square) : 1.0;
    return options_.wind + fade * cross(options_.wind_spin, arm);
}

/// Of the liquid, per mass [m/s^2].
Vec3 MelpSolver::weight_at(std::size_t i) const {
    return heat_.weight_factor(films_.temperature[i]) * input_.films->material.gravity;
}

/// What the slope of the surfactant on both interfaces pulls with along the film, per area [N/m^2].
std::vector<Vec3> MelpSolver::surfactant_pull(std::span<const double> pressing) const {
    std::vector<Vec3> pull = gradient(geometry_, coarse_.position, pressing);
    for (Vec3& p : pull) p = (-2.0 * law_.thermal_energy()) * p;
    return pull;
}

/// Likewise what else films pull themselves with: warm interfaces are less tense, borders of black film have a tension.
std::vector<Vec3> MelpSolver::other_pull() const {
    std::vector<Vec3> pull(coarse_.size());
    if (heat_.on()) {
        std::vector<double> extra;
        for (const double t : films_.temperature) extra.push_back(2.0 * heat_.extra_tension(t));
        pull = gradient(geometry_, coarse_.position, extra);
    }
    const BlackFilmOptions& black = options_.black_film;
    if (black.thickness > 0.0 && black.line_tension > 0.0) {
        const std::vector<double> chi = blackness(films_.thickness, black.thickness);
        const std::vector<Vec3> line = line_pull(geometry_, coarse_.position, chi, black.line_tension);
        for (std::size_t i = 0; i < pull.size(); ++i) pull[i] += line[i] / geometry_.area[i];
    }
    return pull;
}

/// Gravity, air and surfactant act along the film; what fine particles will take is in coarse_.velocity then. All see
/// the drag at the end of the step: it would weaken one that balances the others, the more the longer the step.
SurfactantStep MelpSolver::push_along_film(double dt) {
    const std::size_t count = coarse_.size();
    std::vector<double> inertia(count);  // of film and drag, per area
    for_each_particle(count, [&](std::size_t i) {
        const Vec3& n = geometry_.normal[i];
        const double film = liquid_density() * films_.thickness[i], drag = dt * options_.air_drag;
        inertia[i] = film + drag;
        Vec3 u = film * (films_.along[i] + dt * weight_at(i)) + drag * wind_at(coarse_.position[i]);
        u -= dot(u, n) * n;
        coarse_.velocity[i] = u / inertia[i] + dot(coarse_.velocity[i], n) * n;
    });
    pull_edges(dt);
    marangoni_.assign(count, {});
    if (fine_.size() == 0) return {};  // constant tension
    const std::vector<Vec3> beside = other_pull();
    for (std::size_t i = 0; i < count; ++i) {
        marangoni_[i] = geometry_.area[i] * beside[i];
        coarse_.velocity[i] += (dt / inertia[i]) * beside[i];
    }
    SurfactantStep step = solve_surfactant(geometry_, coarse_.position, films_, coarse_.velocity, law_, inertia, dt,
                                           options_.solver_tolerance, options_.jacobi_sweeps);
    const std::vector<Vec3> pull = surfactant_pull(step.pressing);
    for (std::size_t i = 0; i < count; ++i) {
        marangoni_[i] += geometry_.area[i] * pull[i];
        coarse_.velocity[i] += (dt / inertia[i]) * pull[i];
    }
    carry_dry_along();
    return step;
}

/// Nothing pulls coarse particles that hardly a fine one reaches: along the film they go with what is around them.
void MelpSolver::carry_dry_along() {
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        if (films_.dry[i] == 0) continue;
        marangoni_[i] = {};
        const std::optional<Vec3> around = mean_around(geometry_, films_.dry, i, coarse_.velocity);
        if (!around) continue;
        const Vec3& n = geometry_.normal[i];
        const Vec3 change = *around - coarse_.velocity[i];
        coarse_.velocity[i] += change - dot(change, n) * n;
    }
}

}  // namespace lamella::melp
