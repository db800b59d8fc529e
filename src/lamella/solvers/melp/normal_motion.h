#pragma once

#include "lamella/film/problem.h"
#include "lamella/linalg/conjugate_gradient.h"
#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/particles.h"

#include <span>
#include <vector>

namespace lamella::melp {

/// What moves films along their normals during one step. One entry per coarse particle, unless said otherwise.
struct NormalProblem {
    const CoarseParticles& coarse;
    const Geometry& geometry;
    std::span<const Gas> gas;                   ///< per region
    std::span<const RimPiece> rims;             ///< that hold films, now
    std::span<const film::Wall> walls;          ///< that films do not pass
    std::span<const double> joined;             ///< per entry of neighbors.other: see Contacts; empty: all have
    double outside_pressure;                    ///< [Pa]
    std::span<const double> mass;               ///< [kg]
    std::span<const double> interface_tension;  ///< sigma of one interface [N/m]
    std::span<const double> velocity;           ///< along the normals, at the start of the step [m/s]
    std::span<const Vec3> internal;             ///< forces along the film that the films exert on each other [N]
    std::span<const Vec3> external;             ///< forces from outside, e.g. weight [N]
    bool even;                                  ///< films without fine particles
    bool floating;                              ///< the air carries the external forces on free bubbles as a whole
    double junction_correction;                 ///< beta of the cohesion
    double damping;                             ///< of all motion along the normals [1/s]
    double shape_damping;                       ///< of what is no flight of a region as a whole [1/s]
    double theta;
    double dt;         ///< [s]
    double tolerance;  ///< of the linear solve
};

struct NormalStep {
    std::vector<double> velocity;  ///< along the normals, at the end of the step [m/s]
    std::vector<double> mean;      ///< what the film moves with during the step [m/s]
    std::vector<double> swept;     ///< by the films of each region: how much its gas has grown [m^3]
    linalg::IterativeSolution solution;
};

/// Tension, cohesion and gas move the films of all regions at once, implicitly [method sheet 16.2, eq. 10]:
///
///   [M (1 + dt damping + dt shape_damping (1 - F)) - theta^2 dt^2 J_film - dt^2 J_gas] v1 = M v0 + dt F0 + theta (1 -
///   theta) dt^2 J_film v0
///
/// with the flight F of each region as a whole, the pair forces and pressures F0, their derivatives J_film along the
/// normals,
///
///   (J_film v)_i = sum_j c_ij (v_j - n_i . n_j v_i),   c_ij = (tau_i + tau_j) / 2 a_i a_j omega_ij,
///
/// and that of each gas, -(p / V) b b^T with the areas b that it pushes on, always fully implicit: the breathing of
/// bubbles is far faster than any step. What v1 sweeps is what it grows by, so that its pressure is in balance after
/// every step, also where theta or dt change. The cosine lets a film move as a whole without resistance: v = U . n
/// changes no force where particles are evenly spread. It stands for the |kappa|^2 of the sheet, sum c (1 - n_i . n_j)
/// = tau a |kappa|^2 in the limit; with curvatures from patches, right to half a percent, a flying bubble gained 0.017
/// % of its speed per millisecond.
///
/// Regions cohere where their films touch [method sheet 16.4, eq. 11]: two films have the tension of one in common, and
/// meet a third at 120 degrees. Internal forces, `internal` along the film counted, neither push nor twist a free
/// cluster as a whole: what discretization leaves is removed.
///
/// Films that face each other too deep push each other back, walls push films back, and particles at folds are held to
/// their film (FoldSprings), as stiff springs: all are in the matrix, and theta is 1 where bubbles touch.
NormalStep move_along_normals(const NormalProblem& problem);

}  // namespace lamella::melp
