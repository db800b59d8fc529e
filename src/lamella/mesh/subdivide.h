#pragma once

#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/foam_mesh.h"

#include <vector>

namespace lamella::mesh {

/// Where a wire runs between the ends of an edge: on the circle through its neighbors along the wire (exact for rings
/// and straight wires), in the middle where the wire has a corner or an end; for edges that are not on a wire their
/// middle. @returns  one place per edge [m]
std::vector<Vec3> edge_middles(const FoamMesh& mesh, const EdgeFaces& edges);

/// Both ends are held by a wire and the edge is no inner edge of a film.
bool is_wire_edge(const FoamMesh& mesh, const EdgeFaces& edges, std::size_t e);

/// Every face cut into four at the given places on its edges; new vertices follow the old ones, in order of edges.
FoamMesh subdivide(const FoamMesh& mesh, const EdgeFaces& edges, const std::vector<Vec3>& middles);

}  // namespace lamella::mesh
