#pragma once

#include "lamella/mesh/foam_mesh.h"

namespace lamella::mesh {

/// One bubble in the shape of a cube, far from rest: six flat sides with sharp edges. Region 1, its target the volume of
/// the cube. @param edge  of the cube [m]  @throws InputError  a size that is not positive, or more than 20 million faces
FoamMesh cube_bubble(const Vec3& center, double edge, double edge_length);

}  // namespace lamella::mesh
