#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <vector>

// Areas of the films and how they change with the vertices. Each triangle contributes on its own, so everything holds
// on any mesh: around triple lines, on wires and in periodic foams.

namespace lamella::mesh {

/// Area times unit normal, (x1 - x0) x (x2 - x0) / 2 [m^2]; it points from the region behind into the region in front.
IdVector<FaceId, Vec3> face_area_vectors(const FoamMesh& mesh);

/// [m^2]
IdVector<FaceId, double> face_areas(const FoamMesh& mesh);

/// Unit normals, from the region behind into the region in front; zero for a face without area.
IdVector<FaceId, Vec3> face_normals(const FoamMesh& mesh);

/// Area of all films [m^2]. A film counts once, though it has two surfaces.
double total_area(const FoamMesh& mesh);

/// Area of all films between two regions, a < b.
struct FilmArea {
    RegionId a;
    RegionId b;
    double area = 0.0;  ///< [m^2]
};

/// One entry for each pair of regions that share a film, ordered by (a, b).
std::vector<FilmArea> film_areas(const FoamMesh& mesh);

/// Gradient of the total area with respect to the vertices.
///
/// For a triangle with unit normal n, and e_k the edge opposite to corner k in the sense of the face:
///   dA/dx_k = n x e_k / 2
/// Turning a face over changes nothing. Minus this times the film tension (2 * surface_tension, a film has two
/// surfaces) is the capillary force on the vertices. A face without area contributes nothing.
///
/// @returns  #V vectors [m]; they sum to zero
/// @see [PinkallPolthier93]
IdVector<VertexId, Vec3> area_gradient(const FoamMesh& mesh);

/// Gradient of the film energy sum_f tension_f A_f.
///
/// @param tension  #F film tensions, 2 * surface_tension [N/m]
/// @returns        #V vectors [N]; they sum to zero
IdVector<VertexId, Vec3> area_gradient(const FoamMesh& mesh, const IdVector<FaceId, double>& tension);

}  // namespace lamella::mesh
