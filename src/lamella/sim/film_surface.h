#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/sim/frame.h"

#include <optional>

namespace lamella::sim {

/// The triangles of a foam mesh as a Frame shows them, with what is known of the regions (`closed`, `target_volume`);
/// `on_wire` is a field of the vertices. Faces of
/// a periodic foam are shown whole: their corners are their own, and there is no such field.
Surface film_surface(const mesh::FoamMesh& mesh);

/// The unit cell of a periodic foam whose periods lie along the axes, from the origin on; none for other foams. Films may
/// reach out of it: each is shown once.
std::optional<Box> film_box(const mesh::FoamMesh& mesh);

}  // namespace lamella::sim
