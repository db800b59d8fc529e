#pragma once

// One step of the films along their normals, together with the surfactant that it stretches.

#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/vortex_particle/air_mass.h"
#include "lamella/solvers/vortex_particle/flow.h"
#include "lamella/solvers/vortex_particle/membrane.h"

#include <span>
#include <vector>

namespace lamella::vortex_particle {

/// The surfactant's equation of one step, unknown dGamma at the vertices of the surface.
struct SurfactantProblem {
    std::vector<double> mass;    ///< A / (dt Gamma)
    std::vector<double> weight;  ///< of triangles, 1 / eta [1/m]
    double stiffness = 0.0;      ///< 2 R T dt / rho
    std::vector<double> right;
    double energy = 0.0;  ///< 2 R T: tension of a film per surfactant on one of its interfaces [J/mol]
    const ShiftedStiffness* factors = nullptr;  ///< about the equation's
};

struct KickProblem {
    const mesh::FoamMesh& mesh;  ///< in the middle of the step, as all that follows
    const Surface& surface;
    const Membrane& membrane;  ///< assembled for this step; factored for some step where no air acts
    double dt;
    std::vector<double> speed;     ///< of the membrane's unknowns at the start [m/s]
    std::vector<double> force;     ///< on them, without gas [N]
    std::vector<double> pressure;  ///< of regions, a guess [Pa]
    std::vector<double> share;     ///< of the air at each vertex of the surface: +-1, to the membrane's direction
    const AirMass* air;            ///< with its inverse for this step; or nothing
    const SurfactantProblem* surfactant;  ///< or nothing, where it does not act
    double tolerance;
};

struct KickStep {
    std::vector<double> speed;       ///< at the end of the step [m/s]
    std::vector<double> surfactant;  ///< dGamma [mol/m^2]; empty without
    std::vector<double> stretch;     ///< rate of area around vertices in the second half of the step [m^2/s]
    std::vector<double> pressure;    ///< of regions over the outside's [Pa]
    int iterations = 0;
    double residual = 0.0;
};

/// The middle of a step from x to x + dt / 2 (v + v'), where forces act [method sheet 5.2, in another form]:
///
///     M' (v' - v) = dt (F + sum_r p_r grad V_r + 2 R T C^T dGamma)      M' = M + dt^2 / 4 S, S the tension's stiffness
///     diag(A / (dt Gamma)) dGamma + (2 R T dt / rho) K_(1/eta) dGamma = right - C v' / 2
///     V_r(x + dt / 2 (v + v')) = V_r0
///
/// With C what films that move stretch. Without surfactant that is the leapfrog method of a system with the inertia M',
/// which is stable whatever the step and keeps its energy, as M' is at least M plus a quarter of dt^2 times what
/// tension does to small waves: waves that the step resolves have their frequency, shorter ones are slower. Stretch and
/// surfactant are solved for together: a film that moves along its normal makes liquid run along it, which adds
/// 4 / (l (l + 1)) of its mass to the mode l of a bubble and, taken from the step before, would grow without bound.
KickStep kick(const KickProblem& problem);

}  // namespace lamella::vortex_particle
