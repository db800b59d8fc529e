#pragma once

#include "lamella/solvers/equilibrium/grading.h"
#include "lamella/solvers/equilibrium/newton.h"
#include "lamella/solvers/equilibrium/patch_angles.h"

#include <vector>

namespace lamella::equilibrium {

/// Quadratic patches at rest, finer where their angles were off.
struct Refined {
    Graded films;
    PatchAngles angles;
};

/// Plateau's laws as a measure of error: where resting patches break them by more than `tolerance`, the patches are too
/// large for the films' curvature there. They are graded (halved, and halved again, as often as the excess asks for) and
/// brought to rest again, until no angle is off by more, or as far as six rounds and eight times the faces go.
///
/// @param start      quadratic patches at rest
/// @param tolerance  [rad]
Refined refine_angles(Graded start,
                      const std::vector<FilmTension>& tension,
                      Goal goal,
                      double tolerance);

}  // namespace lamella::equilibrium
