#pragma once

#include "lamella/mesh/detail/edit_mesh.h"

namespace lamella::mesh::detail {

/// Shortens displacements such that nothing can cross.
///
/// Two primitives (vertex and face, or two edges) that share no vertex and are a distance D apart cannot meet when
/// their vertices move by at most 0.45 D each. A pair whose vertices move by no more than 0.9 D together is left
/// alone; of every other pair all vertices are held to 0.45 D. @returns how many vertices were held back
std::size_t limit_displacement(const EditMesh& mesh, double longest, IdVector<VertexId, Vec3>& displacement);

}  // namespace lamella::mesh::detail
