#pragma once

// Tension in a semi-implicit step, which the fastest capillary waves of the mesh do not limit [method sheet 14.4].

#include "lamella/solvers/vortex_sheet/film_filter.h"

#include "lamella/core/vec.h"
#include "lamella/spatial/vortex_sum.h"

#include <functional>
#include <vector>

namespace lamella::vortex_sheet {

using VertexVelocity = IdVector<mesh::VertexId, Vec3>;

/// The films as a semi-implicit step sees them: where they are expected in the middle of the step, and two operators.
struct ImplicitProblem {
    const mesh::FoamMesh& middle;    ///< the films at time t + theta dt if they moved with `expected`
    const VertexVelocity& expected;  ///< 0 where a wire moves the vertex: there `middle` is exact
    /// d phi / dt that tension asks for, of films whose vertices are anywhere [m^2/s^2]; 0 on wires.
    std::function<Circulation(const mesh::FoamMesh&)> rate;
    /// Velocities of the vertices of `middle` that circulations make [m/s], 0 on wires. `driven`: with those of the
    /// vortices outside of the films.
    std::function<VertexVelocity(const Circulation&, bool driven)> velocity;
    std::function<void(const Circulation&, Circulation&)> precondition;
    double edge_length;  ///< [m]
    double tolerance;    ///< of the residual, relative
};

struct ImplicitStep {
    double dt = 0.0;          ///< [s]
    Circulation phi;          ///< at the end of the step
    VertexVelocity velocity;  ///< of the step
    int evaluations = 0;      ///< of the flow
    double residual = 0.0;    ///< relative
};

/// The theta rule for circulations and positions, linearized about `middle`: y* = theta y(t + dt) + (1 - theta) y(t) has
///
///   y* - theta dt (R + D[theta dt (u(y*) - u_expected)]) = y(t),   R = rate(middle), D its derivative by the positions,
///
/// a difference of the whole discrete rate, junctions included. Solved by GMRES from y(t); the velocities of its vectors
/// add up to that of the answer, so that there is one flow evaluation more than iterations. theta = 1/2 is the implicit
/// midpoint rule: second order, no wave decays. What GMRES leaves acts like a push, so energy is kept to the tolerance.
/// @throws NumericalError  no convergence
ImplicitStep implicit_step(const ImplicitProblem& problem, const Circulation& phi, double theta, double dt);

/// The preconditioner: 1 / (1 + theta^2 dt^2 omega^2(k)), the answer on a flat film of edge length h << 1/k, with
/// omega^2 = sigma / rho * k^3 * kernel_factor(k delta).
/// @param surface_tension  of one interface [N/m]
FilmFilter flat_film_inverse(const FilmLaplacian& laplacian,
                             const spatial::VortexSumOptions& sum,
                             double surface_tension,
                             double density,
                             double theta_dt);

}  // namespace lamella::vortex_sheet
