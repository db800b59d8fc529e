#pragma once

#include "lamella/sim/solver.h"
#include "lamella/solvers/bubble/system.h"

namespace lamella::bubble {

struct Relaxation {
    int iterations = 0;
    double residual = 0.0;  ///< mean |F_i| / mean |F_ij|; 0 when nothing touches
    bool at_rest = false;
};

/// Moves the bubbles, at constant radii and with the liquid at rest, to a minimum of the contact energy by the fast
/// inertial relaxation engine [Bitzek06]. At rest when the mean net force is below start.force_tolerance times the
/// mean contact force, or when the energy per bubble is below 1e-16 sigma_0 <R_in>^2 (bubbles that do not jam).
/// @throws Interrupted
template <int D>
Relaxation relax(System<D>& system, const Options& options, const sim::StartContext& context);

}  // namespace lamella::bubble
