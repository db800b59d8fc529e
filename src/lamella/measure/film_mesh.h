#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/sim/frame.h"

#include <cstdint>
#include <vector>

namespace lamella::measure {

/// The films of a frame as a mesh whose operators can be used.
struct FilmMesh {
    mesh::FoamMesh mesh;              ///< its regions are numbered without gaps
    std::vector<std::int32_t> label;  ///< of each region in the frame; the outside comes first
    /// False where the triangles share no vertices, as those of a foam in a periodic box: then nothing is known of edges.
    bool connected = true;
};

/// Regions are closed where the region field `closed` says so; without it, those whose films leave no rim open.
/// Vertices lie on wires where the vertex field `on_wire` says so; without it, those at edges where a film ends.
/// @throws InputError  a region or vertex that cannot be, fields that do not fit
FilmMesh film_mesh(const sim::Surface& surface);

}  // namespace lamella::measure
