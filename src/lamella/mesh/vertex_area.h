#pragma once

#include "lamella/mesh/foam_mesh.h"

// How much film belongs to a vertex. Both divisions give every part of every face to one of its corners, so they sum
// to the total area on any mesh.

namespace lamella::mesh {

/// A third of each face at the vertex. @returns #V areas [m^2]
IdVector<VertexId, double> barycentric_areas(const FoamMesh& mesh);

/// The part of each face that is nearest to the vertex, if the face has no obtuse angle:
///
///   (|e_ij|^2 cot(angle at k) + |e_ik|^2 cot(angle at j)) / 8
///
/// An obtuse face gives half to the obtuse corner and a quarter to each of the others. [Meyer03, figure 4]
/// @returns #V areas [m^2]
IdVector<VertexId, double> mixed_voronoi_areas(const FoamMesh& mesh);

}  // namespace lamella::mesh
