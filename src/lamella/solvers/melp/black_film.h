#pragma once

#include "lamella/solvers/melp/geometry.h"

#include <span>
#include <vector>

// Newton black films: spots a few nanometers thick in a film of hundreds, with a line tension along their borders.

namespace lamella::melp {

/// How black films of these thicknesses are: 1 / (1 + (eta / limit)^4), 1 in black film and 0 in thick one.
std::vector<double> blackness(std::span<const double> thickness, double limit);

/// What line tension pulls with along the film, per coarse particle [N]: the divergence of the stress
///
///   S = line_tension (|grad chi| P - grad chi (x) grad chi / |grad chi|),   chi = blackness, P onto the film,
///
/// of a border as wide as chi's step. Across the step |grad chi| sums up to 1: the border has the line tension, and a
/// round spot of radius R presses its film with line_tension / R. Pairs push each other with what is between them, so
/// that nothing is left over on a flat film. In the place of [Deng22]'s attractions, which are made for one spacing.
/// [method sheet 9 R]
///
/// @param line_tension  [N]
std::vector<Vec3> line_pull(const Geometry& geometry,
                            std::span<const Vec3> position,
                            std::span<const double> blackness,
                            double line_tension);

}  // namespace lamella::melp
