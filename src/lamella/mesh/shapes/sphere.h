#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/mesh/shapes/power_cluster.h"

#include <vector>

namespace lamella::mesh {

/// Separate spherical bubbles: ball i is region i + 1 in the outside, a subdivided icosahedron projected onto the
/// sphere, its mean edge close to `edge_length` [m]. Target volumes are those of the exact balls.
/// @throws InputError  no balls, balls that touch, a size that is not positive, or more than 20 million faces
FoamMesh spheres(const std::vector<Ball>& balls, double edge_length);

}  // namespace lamella::mesh
