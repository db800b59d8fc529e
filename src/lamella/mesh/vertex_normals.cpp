#include "lamella/mesh/vertex_normals.h"

#include "lamella/mesh/detail/triangle.h"
#include "lamella/mesh/vertex_regions.h"

namespace lamella::mesh {
namespace {

/// Sum over faces at each vertex of sign(face) * weight * normal, made unit.
template <class Sign>
IdVector<VertexId, Vec3> weighted_normals(const FoamMesh& mesh, NormalWeight weight, Sign&& sign) {
    IdVector<VertexId, Vec3> normals(mesh.position.size());
    for (const FaceId f : mesh.faces.ids()) {
        const double s = sign(mesh.faces[f]);
        if (s == 0.0) continue;
        const detail::Triangle x = detail::triangle(mesh, f);
        const Vec3 area_vector = s * detail::doubled_area_vector(x);
        const Vec3 unit = detail::direction(area_vector);
        for (std::size_t k = 0; k < 3; ++k)
            normals[mesh.faces[f].vertices[k]] +=
                weight == NormalWeight::kArea ? area_vector : detail::angle(x, k) * unit;
    }
    for (Vec3& normal : normals) normal = detail::direction(normal);
    return normals;
}

}  // namespace

IdVector<VertexId, Vec3> region_normals(const FoamMesh& mesh, RegionId region, NormalWeight weight) {
    return weighted_normals(mesh, weight, [region](const Face& face) {
        return face.back == region ? 1.0 : face.front == region ? -1.0 : 0.0;
    });
}

IdVector<VertexId, Vec3> film_normals(const FoamMesh& mesh, NormalWeight weight) {
    const VertexRegions regions = vertex_regions(mesh);
    IdVector<VertexId, Vec3> normals =
        weighted_normals(mesh, weight, [](const Face& face) { return face.front < face.back ? 1.0 : -1.0; });
    for (const VertexId v : normals.ids())
        if (regions.of(v).size() != 2) normals[v] = {};
    return normals;
}

}  // namespace lamella::mesh
