#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <cstdint>

namespace lamella::mesh {

enum class NormalWeight : std::uint8_t {
    kArea,   ///< by the area of the face
    kAngle,  ///< by its angle at the vertex: does not depend on how the film is cut into triangles
};

/// Unit normals of one region's surface at its vertices, out of the region.
/// @returns  #V unit vectors; zero at vertices that the region does not touch
IdVector<VertexId, Vec3> region_normals(const FoamMesh& mesh, RegionId region, NormalWeight weight);

/// Unit normals at vertices inside a film, where exactly two regions meet. They point into the region of the smaller
/// number: out of a bubble into the outside.
/// @returns  #V unit vectors; zero at all other vertices
IdVector<VertexId, Vec3> film_normals(const FoamMesh& mesh, NormalWeight weight);

}  // namespace lamella::mesh
