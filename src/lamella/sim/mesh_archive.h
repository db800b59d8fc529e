#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/sim/archive.h"

#include <string>

namespace lamella::sim {

/// A mesh under names that begin with `group` ("mesh/position" ...), bit for bit.
void save_mesh(StateWriter& out, const std::string& group, const mesh::FoamMesh& mesh);

/// @throws InputError  something is missing, or ids do not fit together
mesh::FoamMesh load_mesh(StateReader& in, const std::string& group);

}  // namespace lamella::sim
