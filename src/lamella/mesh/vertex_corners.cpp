#include "lamella/mesh/vertex_corners.h"

#include <numeric>

namespace lamella::mesh {

VertexCorners vertex_corners(const FoamMesh& mesh) {
    VertexCorners corners;
    corners.start.assign(mesh.position.size() + 1, 0);
    for (const Face& face : mesh.faces)
        for (const VertexId v : face.vertices) ++corners.start[index(v) + 1];
    std::partial_sum(corners.start.begin(), corners.start.end(), corners.start.begin());

    corners.corner.resize(corners.start.back());
    std::vector<std::size_t> next(corners.start.begin(), corners.start.end() - 1);
    for (const FaceId f : mesh.faces.ids())
        for (std::uint32_t k = 0; k < 3; ++k) corners.corner[next[index(mesh.faces[f].vertices[k])]++] = {f, k};
    return corners;
}

}  // namespace lamella::mesh
