#pragma once

#include "lamella/mesh/foam_mesh.h"

namespace lamella::mesh {

/// Adds separate films to a mesh: its outside is theirs too, their other regions follow those of the mesh.
/// @throws InputError  one of them is periodic
void join(FoamMesh& mesh, const FoamMesh& other);

}  // namespace lamella::mesh
