#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/sim/frame.h"

namespace lamella::sim {

/// The triangles of a foam mesh as a Frame shows them, with what is known of the regions (`closed`, `target_volume`);
/// `on_wire` is a field of the vertices. Faces of
/// a periodic foam are shown whole: their corners are their own, and there is no such field.
Surface film_surface(const mesh::FoamMesh& mesh);

}  // namespace lamella::sim
