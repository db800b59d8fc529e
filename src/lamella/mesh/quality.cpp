#include "lamella/mesh/quality.h"

#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/detail/triangle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lamella::mesh {

double min_angle(const FoamMesh& mesh) {
    double smallest = std::numbers::pi;
    for (const FaceId f : mesh.faces.ids()) {
        const detail::Triangle x = detail::triangle(mesh, f);
        for (std::size_t k = 0; k < 3; ++k) smallest = std::min(smallest, detail::angle(x, k));
    }
    return smallest;
}

EdgeLengths edge_lengths(const FoamMesh& mesh) {
    const EdgeFaces edges = edge_faces(mesh);
    if (edges.size() == 0) return {};
    std::vector<double> length(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) length[e] = norm(edge_vector(mesh, edges.of(e).front()));

    const auto count = static_cast<double>(length.size());
    EdgeLengths statistics{.count = length.size()};
    statistics.shortest = std::ranges::min(length);
    statistics.longest = std::ranges::max(length);
    for (const double l : length) statistics.mean += l / count;
    double variance = 0.0;
    for (const double l : length) variance += (l - statistics.mean) * (l - statistics.mean) / count;
    statistics.deviation = std::sqrt(variance);
    return statistics;
}

}  // namespace lamella::mesh
