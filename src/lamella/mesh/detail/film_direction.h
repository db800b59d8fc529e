#pragma once

#include "lamella/core/vec.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/vertex_corners.h"
#include "lamella/mesh/foam_mesh.h"

#include <cstddef>

namespace lamella::mesh::detail {

/// The unit vector in which the face at an edge leaves it: in the plane of the face, perpendicular to the edge.
Vec3 flat_film_direction(const FoamMesh& mesh, const EdgeUse& use);

/// The same for the curved film that the face belongs to, at the middle of the edge, from a quadratic patch.
/// The direction of the face if the film has too few vertices near by.
/// @param rings  of faces around the face that the patch has, at least
Vec3 quadratic_film_direction(const FoamMesh& mesh, const VertexCorners& corners, const EdgeUse& use, int rings = 1);

}  // namespace lamella::mesh::detail
