#pragma once

#include "lamella/solvers/melp/particles.h"

namespace lamella::melp {

/// Puts fine particles that are near in space near in memory: along a Z-shaped curve through cells of half a spacing,
/// one region after the other.
void sort_fine_particles(FineParticles& fine, double spacing);

}  // namespace lamella::melp
