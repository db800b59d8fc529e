#pragma once

#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/rims.h"

#include <span>
#include <vector>

namespace lamella::melp {

/// The volume that closes in under the particles of each region, sum a (x - o) . n / 3 about their center o, or a point
/// of the plate that they stand on, times the calibration of its gas [m^3]. Where other bubbles are near, stars of
/// triangles take the place of a (x - o) . n / 3: they are right at folds but flicker with the choice of triangles; and
/// half of what joined bubbles share is taken off. Without meaning for films without gas.
/// @param joined  per entry of the neighbors in other regions: see Contacts; empty: all have
std::vector<double> particle_volumes(const CoarseParticles& coarse,
                                     const Geometry& geometry,
                                     std::span<const RimPiece> rims,
                                     const std::vector<Gas>& gas,
                                     std::span<const double> joined);

}  // namespace lamella::melp
