#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <optional>

namespace lamella::measure::detail {

/// The mesh with a flat end on each closed region whose films do not close it in: half a bubble on a plate, a bubble
/// with a hole. Every loop of open edges gets a fan of triangles around the mean of its vertices. Nothing where all
/// regions are closed already.
std::optional<mesh::FoamMesh> with_flat_ends(const mesh::FoamMesh& mesh);

}  // namespace lamella::measure::detail
