#pragma once

#include "lamella/solvers/melp/normal_motion.h"

#include <cstddef>
#include <span>
#include <vector>

// What pairs of coarse particles do to each other along the normals: tension, cohesion, and what keeps films apart.

namespace lamella::melp {

/// The tension of the particle's own film and that toward other regions, per interface tension, where gamma of film of
/// other regions lies at the particle: 1 where two films coincide, more where three bubbles meet. Both follow from one
/// energy, sigma a (2 - f): [method sheet 16.4; there gamma ended at 1, which is no energy's]
///
///   f = gamma + beta gamma (1 - gamma),  f' = (1 - beta) gamma^-6 beyond 1
struct Cohesion {
    double own;    ///< tau / sigma = 2 - f - gamma f'
    double other;  ///< f'
};
Cohesion cohesion(double gamma, double beta);

/// What keeps films that fly at each other from passing through, as a spring along the normals of a pair: it is
/// strained where particle i stands deeper in the other bubble than films may. Gas alone presses joined films a quarter
/// of a spacing into each other; those that have not joined keep a spacing of air between them.
struct Spring {
    double stiffness;  ///< force along n_i over the velocity along n_i, or along n_j, times the time [N/m]
    double force;      ///< along n_i, into the own bubble [N]
};

/// The springs of all walls on one particle.
Spring spring_of_walls(const NormalProblem& problem, std::size_t i);

/// Strengths of the pairs: c_ij, of one region and of two. [N/m]
struct Pairs {
    std::vector<double> gamma;  ///< film of joined regions that lies at each particle
    std::vector<double> own;    ///< tau_i per particle
    RawVector<double> same;     ///< per entry of neighbors.same
    RawVector<double> other;    ///< per entry of neighbors.other
    std::vector<double> image;  ///< per entry of images
    RawVector<Spring> push;     ///< per entry of neighbors.other: what keeps films apart
};

Pairs pair_strengths(const NormalProblem& problem);

/// Tension and cohesion along the normals, and what keeps films apart. [N]
std::vector<double> pair_forces(const NormalProblem& problem, const Pairs& pairs);

}  // namespace lamella::melp
