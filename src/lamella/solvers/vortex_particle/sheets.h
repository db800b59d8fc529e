#pragma once

// Films that meet in triple lines, as sheets: each has one flow, which goes on into the others there.

#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/vortex_particle/surface.h"

namespace lamella::vortex_particle {

/// Lays the triangles, what lies beside each, and vertices into an empty surface. [method sheet 9]
///
/// A film up to its triple lines is a sheet of its own, with its own vertices there; `joint` tells which of them lie at
/// one place. Thickness, surfactant and the potential of the flow are the same for all of them, so that what flows out
/// of one film over the line flows into the others; the stream function is constant along the line, as along a wall:
/// swirls do not reach over it, but particles that are carried over it take theirs along.
/// @throws InputError  neighboring triangles of a film face opposite ways
void lay_sheets(const mesh::FoamMesh& mesh, Surface& s);

}  // namespace lamella::vortex_particle
