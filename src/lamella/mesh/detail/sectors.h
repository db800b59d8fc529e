#pragma once

#include "lamella/core/small_vector.h"
#include "lamella/mesh/detail/edit_mesh.h"

#include <cstdint>
#include <optional>

namespace lamella::mesh::detail {

/// +1 when face f runs from v to w, -1 when it runs from w to v.
int direction(const Face& face, VertexId v, VertexId w);

/// The label on the side of `face` that comes next when turning counterclockwise about the edge v -> w, and the one
/// that came before it.
RegionId ahead_of(const Face& face, VertexId v, VertexId w);
RegionId behind_of(const Face& face, VertexId v, VertexId w);

/// Puts the faces of edge v -> w into counterclockwise order about it (seen against its direction).
void sort_around(const EditMesh& mesh, VertexId v, VertexId w, SmallVector<FaceId, 8>& faces);

/// True when, going around edge v -> w, each face's far label is the next face's near label. Edges between two wire
/// vertices may be open: always true.
bool label_cycle_holds(const EditMesh& mesh, VertexId v, VertexId w);

/// What the films at a vertex divide its surroundings into.
///
/// A sector is a part of space at the vertex that no film cuts: the sides of faces, united across the edges of the
/// vertex by going around each. Two sectors may carry the same region (a neck). A vertex is regular when its faces
/// hang together and every two of its sectors share a face: inside a film, on a triple line, at a junction of four.
struct Sectors {
    /// Per face of faces_at(v): its link component, and its two sectors (back, front).
    struct Place {
        std::uint8_t component;
        std::uint8_t back, front;
    };
    SmallVector<Place, 12> faces;
    SmallVector<RegionId, 8> labels;          ///< of each sector
    std::uint8_t components = 0;              ///< of faces joined by edges at v
    SmallVector<std::uint32_t, 8> neighbors;  ///< per sector: bit set of the sectors that share a face with it

    std::size_t count() const { return labels.size(); }
    bool regular() const;
};

/// @returns nothing when v has more faces or sectors than any mesh in use (100 faces, 32 sectors), or its labels do
///          not fit together: such a vertex is left alone.
std::optional<Sectors> sectors_at(const EditMesh& mesh, VertexId v);

/// sectors_at(v)->regular(), found without geometry where no edge of v has more than three faces. Vertices on wires
/// count as regular unless films cross there.
bool is_regular(const EditMesh& mesh, VertexId v);

}  // namespace lamella::mesh::detail
