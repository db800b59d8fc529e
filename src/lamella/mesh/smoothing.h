#pragma once

#include "lamella/mesh/foam_mesh.h"

namespace lamella::mesh {

/// Displacement that evens out the triangles without changing the films' shape [m].
///
/// Inside a film: 1.5 * strength of the way to the area-weighted centroid of the faces around, in the film's plane.
/// On a triple line: `strength` of the way to the middle of its two neighbors on the line, along the line. Junctions
/// and wires: none.
IdVector<VertexId, Vec3> tangential_smoothing(const FoamMesh& mesh, double strength = 0.15);

}  // namespace lamella::mesh
