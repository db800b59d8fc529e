#pragma once

// What the films and their circulations live on: the corners, regions and edges of a foam mesh, in the order in which
// the operators of the method walk through them.

#include "lamella/mesh/foam_mesh.h"
#include "lamella/mesh/vertex_corners.h"
#include "lamella/mesh/vertex_regions.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::vortex_sheet {

/// What holds a vertex.
enum class Hold : std::uint8_t {
    kFree,    ///< it moves with the air
    kRim,     ///< a film ends here on a wire: no circulation, it moves with the wire [method sheet 14.3]
    kPinned,  ///< a wire runs through the film: it moves with the wire, and its circulation follows from that
};

/// Which regions and corners meet at each vertex. Changes only when the mesh does.
///
/// The circulation has one value per entry, that is, per vertex and region that touches it. Only differences at one
/// vertex mean anything: Gamma_ab = phi_b - phi_a is the jump of the velocity potential across the film between a
/// (behind) and b (in front).
struct SheetTopology {
    mesh::VertexRegions entries;
    mesh::VertexCorners corners;
    /// Per face and corner: the entries of the vertex with the region behind the face, and with the one in front.
    IdVector<mesh::FaceId, std::array<std::array<std::uint32_t, 2>, 3>> entry;
    IdVector<mesh::VertexId, Hold> hold;
    /// Connected films: a number for each vertex.
    IdVector<mesh::VertexId, std::uint32_t> cluster;
    std::uint32_t clusters = 0;

    std::size_t size() const { return entries.region.size(); }  ///< entries
    std::size_t first(mesh::VertexId v) const { return entries.start[index(v)]; }
    std::size_t last(mesh::VertexId v) const { return entries.start[index(v) + 1]; }
};

SheetTopology sheet_topology(const mesh::FoamMesh& mesh);

/// Circulations: phi, one per entry of a SheetTopology [m^2/s].
using Circulation = std::vector<double>;

/// Gamma at corner k of a face: phi_front - phi_back [m^2/s].
inline double jump(const SheetTopology& topology, const Circulation& phi, mesh::FaceId f, std::size_t k) {
    const auto& e = topology.entry[f][k];
    return phi[e[1]] - phi[e[0]];
}

/// The free constant of each vertex is chosen such that its values sum to zero.
void fix_gauge(const SheetTopology& topology, Circulation& phi);

}  // namespace lamella::vortex_sheet
