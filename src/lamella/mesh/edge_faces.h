#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::mesh {

/// An edge, a < b. In a periodic foam two vertices may share several edges, which lead to different images of b.
struct EdgeKey {
    VertexId a;
    VertexId b;
    std::array<std::int16_t, 3> shift{};  ///< periods from the image of a to the image of b

    friend auto operator<=>(const EdgeKey&, const EdgeKey&) = default;
};

/// A face seen from one of its edges.
struct EdgeUse {
    FaceId face;
    std::uint32_t opposite;  ///< the corner that is not on the edge
    bool forward;            ///< the face runs from a to b
};

/// All edges of a mesh, ordered by key, with the faces around each, ordered by number.
struct EdgeFaces {
    std::vector<EdgeKey> edge;
    std::vector<std::size_t> start;  ///< #E + 1
    std::vector<EdgeUse> use;        ///< 3 #F

    std::size_t size() const { return edge.size(); }
    std::span<const EdgeUse> of(std::size_t e) const {
        return std::span(use).subspan(start[e], start[e + 1] - start[e]);
    }
};

EdgeFaces edge_faces(const FoamMesh& mesh);

/// The vector from a to b along an edge, taken from one face at it [m].
inline Vec3 edge_vector(const FoamMesh& mesh, const EdgeUse& use) {
    const Vec3 along = mesh.corner(use.face, (use.opposite + 2) % 3) - mesh.corner(use.face, (use.opposite + 1) % 3);
    return use.forward ? along : -along;
}

}  // namespace lamella::mesh
