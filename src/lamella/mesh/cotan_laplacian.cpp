#include "lamella/mesh/cotan_laplacian.h"

#include "lamella/mesh/detail/triangle.h"
#include "lamella/mesh/vertex_corners.h"

#include <algorithm>

namespace lamella::mesh {
namespace {

/// The vertices that share a face with v, and v itself, in order; empty if v has no face.
void neighbors(const FoamMesh& mesh, std::span<const Corner> corners, std::vector<VertexId>& row) {
    row.clear();
    for (const Corner& corner : corners)
        for (const VertexId v : mesh.faces[corner.face].vertices) row.push_back(v);
    std::ranges::sort(row);
    row.erase(std::unique(row.begin(), row.end()), row.end());
}

VertexMatrix zero_matrix(const FoamMesh& mesh) {
    const VertexCorners corners = vertex_corners(mesh);
    VertexMatrix matrix;
    matrix.start.reserve(mesh.position.size() + 1);
    matrix.start.push_back(0);
    std::vector<VertexId> row;
    for (const VertexId v : mesh.position.ids()) {
        neighbors(mesh, corners.of(v), row);
        matrix.column.insert(matrix.column.end(), row.begin(), row.end());
        matrix.start.push_back(matrix.column.size());
    }
    matrix.value.resize(matrix.column.size());
    return matrix;
}

double& at(VertexMatrix& matrix, VertexId row, VertexId column) {
    const auto first = matrix.column.begin() + static_cast<std::ptrdiff_t>(matrix.start[index(row)]);
    const auto last = matrix.column.begin() + static_cast<std::ptrdiff_t>(matrix.start[index(row) + 1]);
    return matrix.value[static_cast<std::size_t>(std::lower_bound(first, last, column) - matrix.column.begin())];
}

}  // namespace

VertexMatrix cotan_laplacian(const FoamMesh& mesh) {
    VertexMatrix matrix = zero_matrix(mesh);
    for (const FaceId f : mesh.faces.ids()) {
        const detail::Triangle x = detail::triangle(mesh, f);
        const double doubled_area = norm(detail::doubled_area_vector(x));
        if (doubled_area == 0.0) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId i = mesh.faces[f].vertices[(k + 1) % 3];
            const VertexId j = mesh.faces[f].vertices[(k + 2) % 3];
            const double half_cot = 0.5 * dot(x[(k + 1) % 3] - x[k], x[(k + 2) % 3] - x[k]) / doubled_area;
            at(matrix, i, i) += half_cot;
            at(matrix, j, j) += half_cot;
            at(matrix, i, j) -= half_cot;
            at(matrix, j, i) -= half_cot;
        }
    }
    return matrix;
}

}  // namespace lamella::mesh
