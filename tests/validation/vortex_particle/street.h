#pragma once

// A disk that stands in a stream: the street of vortices behind it, and what the film does to it [method sheet 12.4].

#include "films.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace lamella::vortex_particle {

/// A disk of diameter 1 m in a stream of 1 m/s between walls that let it slip, 12 m long and 10 m wide, in fine edges around it.
inline std::unique_ptr<VortexParticleSolver> street(double reynolds, double fine_edge) {
    return solver_of(fmt::format(R"(
[material]
kinematic_viscosity = {}
[[film]]
shape = "rectangle"
center = [-4, -5, 0]
u = [12, 0, 0]
v = [0, 10, 0]
focus = [0.2, 0, 0]
focus_radius = 0.7
focus_edge = {}
[[solid]]
center = [0, 0.02, 0]
radius = 0.5
[resolution]
edge_length = 0.25
[vortex_particle]
incompressible = true
particles_per_triangle = 4
largest_step = 0.1
courant = 1.5
[vortex_particle.stream]
velocity = [1, 0, 0]
)", 1.0 / reynolds, fine_edge));
}

struct StreetRun {
    double strouhal = 0.0;  ///< frequency of the lift times diameter over speed
    double drag = 0.0;      ///< 2 force / (rho eta U^2 D): of the mean over whole periods
    double lift = 0.0;      ///< amplitude, likewise
};

/// From zeros of the lift in the last `periods` periods before `until`.
inline StreetRun run_street(VortexParticleSolver& solver, double until, std::size_t periods) {
    constexpr double kScale = 2.0 / (1000.0 * 4e-7);
    solver.start({});
    std::vector<double> time, drag, lift, zeros;
    while (solver.time() < until) {
        solver.advance(until);
        const Vec3& force = solver.bodies()[0].force;
        time.push_back(solver.time());
        drag.push_back(kScale * force[0]);
        lift.push_back(kScale * force[1]);
        const std::size_t k = time.size() - 1;
        if (k > 0 && lift[k - 1] < 0.0 && lift[k] >= 0.0)
            zeros.push_back(time[k] - (time[k] - time[k - 1]) * lift[k] / (lift[k] - lift[k - 1]));
    }
    StreetRun run;
    if (zeros.size() <= periods) return run;
    const double from = zeros[zeros.size() - 1 - periods], to = zeros.back();
    run.strouhal = static_cast<double>(periods) / (to - from);
    double span = 0.0, square = 0.0;
    for (std::size_t k = 1; k < time.size(); ++k) {
        if (time[k] <= from || time[k] > to) continue;
        const double dt = time[k] - time[k - 1];
        span += dt;
        run.drag += dt * drag[k];
        square += dt * lift[k] * lift[k];
    }
    run.drag /= span;
    run.lift = std::sqrt(2.0 * square / span);
    return run;
}

}  // namespace lamella::vortex_particle
