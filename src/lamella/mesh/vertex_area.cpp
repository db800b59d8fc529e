#include "lamella/mesh/vertex_area.h"

#include "lamella/mesh/detail/triangle.h"

namespace lamella::mesh {
namespace {

/// Shares of the three corners in a face of the given area.
std::array<double, 3> voronoi_shares(const detail::Triangle& x, double area) {
    std::array<double, 3> cosine_part{};  // edges at a corner, dotted: 2 area cot(angle)
    for (std::size_t k = 0; k < 3; ++k) cosine_part[k] = dot(x[(k + 1) % 3] - x[k], x[(k + 2) % 3] - x[k]);
    for (std::size_t k = 0; k < 3; ++k)
        if (cosine_part[k] <= 0.0) {
            std::array<double, 3> shares{0.25 * area, 0.25 * area, 0.25 * area};
            shares[k] = 0.5 * area;
            return shares;
        }
    std::array<double, 3> shares{};
    for (std::size_t k = 0; k < 3; ++k) {
        // The edge opposite to k, cut in the middle, gives the same to both its ends.
        const double part = squared_norm(detail::opposite_edge(x, k)) * cosine_part[k] / (16.0 * area);
        shares[(k + 1) % 3] += part;
        shares[(k + 2) % 3] += part;
    }
    return shares;
}

}  // namespace

IdVector<VertexId, double> barycentric_areas(const FoamMesh& mesh) {
    IdVector<VertexId, double> areas(mesh.position.size());
    for (const FaceId f : mesh.faces.ids()) {
        const double third = norm(detail::doubled_area_vector(detail::triangle(mesh, f))) / 6.0;
        for (const VertexId v : mesh.faces[f].vertices) areas[v] += third;
    }
    return areas;
}

IdVector<VertexId, double> mixed_voronoi_areas(const FoamMesh& mesh) {
    IdVector<VertexId, double> areas(mesh.position.size());
    for (const FaceId f : mesh.faces.ids()) {
        const detail::Triangle x = detail::triangle(mesh, f);
        const std::array<double, 3> shares = voronoi_shares(x, 0.5 * norm(detail::doubled_area_vector(x)));
        for (std::size_t k = 0; k < 3; ++k) areas[mesh.faces[f].vertices[k]] += shares[k];
    }
    return areas;
}

}  // namespace lamella::mesh
