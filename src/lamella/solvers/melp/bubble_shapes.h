#pragma once

#include "lamella/core/vec.h"
#include "lamella/mesh/foam_mesh.h"
#include "lamella/mesh/shapes/power_cluster.h"

#include <array>
#include <optional>
#include <vector>

namespace lamella::melp {

/// The surface of one closed region.
struct RegionSurface {
    std::vector<std::array<Vec3, 3>> triangle;  ///< seen from outside in mathematical order
    std::vector<Vec3> vertex, normal;           ///< its vertices, and the area vectors around them
    double area = 0.0;
};

RegionSurface surface_of(const mesh::FoamMesh& mesh, mesh::RegionId region);

/// The ball whose surface this is, if all vertices are at one distance from their mean.
std::optional<mesh::Ball> ball_of(const RegionSurface& surface);

/// Bubbles that do not start from the mesh: regions of clusters whose cells have not the volumes they should, as balls.
IdVector<mesh::RegionId, std::optional<mesh::Ball>> loose_balls(const mesh::FoamMesh& mesh);

}  // namespace lamella::melp
