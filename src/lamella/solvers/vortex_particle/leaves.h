#pragma once

// Films that bound bubbles, as the flow sees them: each bubble has a closed leaf of its own around it.

#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/vortex_particle/surface.h"

namespace lamella::vortex_particle {

/// Lays the triangles, what lies beside each, and vertices into an empty surface. [Tao24, section 5.2; method sheet 9]
///
/// A film between a bubble and open air is one leaf, that between two bubbles two: each has half of the liquid and one
/// of the interfaces, belongs to the closed surface around its bubble and flows on its own, over the triple lines that
/// the bubble has part in. Films between regions that are all open are leaves too, which must not meet in triple lines.
/// Corners run counterclockwise seen from outside of the bubble.
/// @throws InputError  films without bubbles that meet in a triple line or face opposite ways
void lay_leaves(const mesh::FoamMesh& mesh, Surface& s);

}  // namespace lamella::vortex_particle
