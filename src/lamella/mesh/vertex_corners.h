#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::mesh {

/// Corner k of a face.
struct Corner {
    FaceId face;
    std::uint32_t k;
};

/// The corners that lie at each vertex, ordered by face.
struct VertexCorners {
    std::vector<std::size_t> start;  ///< #V + 1
    std::vector<Corner> corner;      ///< 3 #F

    std::span<const Corner> of(VertexId v) const {
        return std::span(corner).subspan(start[index(v)], start[index(v) + 1] - start[index(v)]);
    }
};

VertexCorners vertex_corners(const FoamMesh& mesh);

}  // namespace lamella::mesh
