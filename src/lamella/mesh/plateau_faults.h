#pragma once

#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/foam_mesh.h"

#include <cstddef>
#include <vector>

namespace lamella::mesh {

/// Where Plateau's laws cannot hold whatever the shape: films at rest meet by threes along lines, and lines by fours.
struct PlateauFaults {
    std::vector<std::size_t> edges;   ///< with more than three films, and none between two wire vertices
    std::vector<VertexId> vertices;   ///< free ones that are not inside a film, on one triple line, or where four lines
                                      ///< and four regions meet

    bool none() const { return edges.empty() && vertices.empty(); }
};
PlateauFaults plateau_faults(const FoamMesh& mesh, const EdgeFaces& edges);

}  // namespace lamella::mesh
