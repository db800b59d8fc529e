#pragma once

#include "lamella/linalg/conjugate_gradient.h"
#include "lamella/solvers/melp/films.h"

#include <span>
#include <vector>

namespace lamella::melp {

struct SurfactantStep {
    std::vector<double> pressing;  ///< at the end of the step, see Films [mol/m^2]; drives the flow, is not transported
    linalg::IterativeSolution solution;
};

/// Surfactant at the end of a step in which it drives the flow along the film and is carried by it: elastic waves
/// faster than the step are damped, not unstable.
///
/// From Gamma = Gamma* (1 - dt div u) and u = u* - dt 2 R T / m grad Gamma, times a_i:
///
///   (a_i / Gamma*_i) Gamma_i - dt^2 sum_j a_i a_j beta_ij omega_ij (Gamma_j - Gamma_i) = a_i (1 - dt div u*_i)
///
/// beta = 2 R T / m, harmonic mean of a pair, omega the Laplacian's weights: symmetric, positive definite; edges let
/// nothing through. [method sheet 6 R, eq. 8]
///
/// Films that are warmer than the law's temperature have the concentration that presses as hard in the place of Gamma.
///
/// @param velocity  u*, all forces but the surfactant's applied [m/s]
/// @param inertia   m, that of the film per area, rho eta, and what drag of the air adds in a step [kg/m^2]
/// @param jacobi_sweeps  more than 0: so many relaxed sweeps in the place of conjugate gradients, as [Deng22] makes
SurfactantStep solve_surfactant(const Geometry& geometry,
                                std::span<const Vec3> position,
                                const Films& films,
                                std::span<const Vec3> velocity,
                                const film::SurfactantLaw& law,
                                std::span<const double> inertia,
                                double dt,
                                double tolerance,
                                int jacobi_sweeps);

}  // namespace lamella::melp
