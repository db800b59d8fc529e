#include "lamella/mesh/area.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/mesh/detail/triangle.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

namespace lamella::mesh {
namespace {

template <class Value, class Function>
IdVector<FaceId, Value> for_each_face(const FoamMesh& mesh, Function&& function) {
    IdVector<FaceId, Value> values(mesh.faces.size());
    parallel_for(mesh.faces.size(), [&](std::size_t i) {
        const FaceId f{static_cast<std::uint32_t>(i)};
        values[f] = function(0.5 * detail::doubled_area_vector(detail::triangle(mesh, f)));
    });
    return values;
}

template <class Tension>
IdVector<VertexId, Vec3> weighted_area_gradient(const FoamMesh& mesh, Tension&& tension) {
    std::vector<std::array<Vec3, 3>> slope(mesh.faces.size());
    parallel_for(slope.size(), [&](std::size_t i) {
        const auto f = static_cast<FaceId>(i);
        const detail::Triangle x = detail::triangle(mesh, f);
        const Vec3 half_normal = 0.5 * tension(f) * detail::direction(detail::doubled_area_vector(x));
        for (std::size_t k = 0; k < 3; ++k) slope[i][k] = cross(half_normal, detail::opposite_edge(x, k));
    });
    IdVector<VertexId, Vec3> gradient(mesh.position.size());
    for (const FaceId f : mesh.faces.ids())
        for (std::size_t k = 0; k < 3; ++k) gradient[mesh.faces[f].vertices[k]] += slope[index(f)][k];
    return gradient;
}

}  // namespace

IdVector<FaceId, Vec3> face_area_vectors(const FoamMesh& mesh) {
    return for_each_face<Vec3>(mesh, [](const Vec3& area_vector) { return area_vector; });
}

IdVector<FaceId, double> face_areas(const FoamMesh& mesh) {
    return for_each_face<double>(mesh, [](const Vec3& area_vector) { return norm(area_vector); });
}

IdVector<FaceId, Vec3> face_normals(const FoamMesh& mesh) {
    return for_each_face<Vec3>(mesh, [](const Vec3& area_vector) { return detail::direction(area_vector); });
}

double total_area(const FoamMesh& mesh) {
    return parallel_sum(mesh.faces.size(), [&](std::size_t i) {
        const FaceId f{static_cast<std::uint32_t>(i)};
        return 0.5 * norm(detail::doubled_area_vector(detail::triangle(mesh, f)));
    });
}

std::vector<FilmArea> film_areas(const FoamMesh& mesh) {
    const IdVector<FaceId, double> areas = face_areas(mesh);
    std::map<std::pair<RegionId, RegionId>, double> area_of;
    for (const FaceId f : mesh.faces.ids()) {
        const Face& face = mesh.faces[f];
        area_of[std::minmax(face.back, face.front)] += areas[f];
    }
    std::vector<FilmArea> films;
    films.reserve(area_of.size());
    for (const auto& [pair, area] : area_of) films.push_back({pair.first, pair.second, area});
    return films;
}

IdVector<VertexId, Vec3> area_gradient(const FoamMesh& mesh) {
    return weighted_area_gradient(mesh, [](FaceId) { return 1.0; });
}

IdVector<VertexId, Vec3> area_gradient(const FoamMesh& mesh, const IdVector<FaceId, double>& tension) {
    LAMELLA_ASSERT(tension.size() == mesh.faces.size());
    return weighted_area_gradient(mesh, [&](FaceId f) { return tension[f]; });
}

}  // namespace lamella::mesh
