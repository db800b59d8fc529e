#include "lamella/mesh/detail/film_direction.h"

#include "lamella/mesh/detail/quadratic_slope.h"
#include "lamella/mesh/detail/triangle.h"

#include <algorithm>
#include <vector>

namespace lamella::mesh::detail {
namespace {

constexpr std::size_t kEnoughPoints = 9;  // for six coefficients: less leaves the fit at the mercy of one vertex

bool same_film(const Face& a, const Face& b) {
    return (a.back == b.back && a.front == b.front) || (a.back == b.front && a.front == b.back);
}

/// A vertex of a patch, at the image that is next to the patch.
struct PatchVertex {
    VertexId id;
    Vec3 at;
};

/// Adds the vertices of all faces of the film at the patch's vertices. Offsets within a face are exact in periodic
/// foams too, so a vertex is placed relative to the one through which it was reached.
void grow(const FoamMesh& mesh, const VertexCorners& corners, const Face& film, std::vector<PatchVertex>& patch) {
    const std::size_t known = patch.size();
    for (std::size_t i = 0; i < known; ++i)
        for (const Corner& corner : corners.of(patch[i].id)) {
            const Face& face = mesh.faces[corner.face];
            if (!same_film(face, film)) continue;
            const Vec3 offset = patch[i].at - mesh.corner(corner.face, corner.k);
            for (std::size_t k = 0; k < 3; ++k)
                if (std::ranges::find(patch, face.vertices[k], &PatchVertex::id) == patch.end())
                    patch.push_back({face.vertices[k], mesh.corner(corner.face, k) + offset});
        }
}

std::vector<PatchVertex> patch_around(const FoamMesh& mesh, const VertexCorners& corners, FaceId f, int rings) {
    std::vector<PatchVertex> patch;
    for (std::size_t k = 0; k < 3; ++k) patch.push_back({mesh.faces[f].vertices[k], mesh.corner(f, k)});
    for (int ring = 0; ring < rings; ++ring) grow(mesh, corners, mesh.faces[f], patch);
    if (patch.size() < kEnoughPoints) grow(mesh, corners, mesh.faces[f], patch);
    return patch;
}

}  // namespace

Vec3 flat_film_direction(const FoamMesh& mesh, const EdgeUse& use) {
    const Triangle x = triangle(mesh, use.face);
    return direction(cross(doubled_area_vector(x), opposite_edge(x, use.opposite)));
}

Vec3 quadratic_film_direction(const FoamMesh& mesh, const VertexCorners& corners, const EdgeUse& use, int rings) {
    const Vec3 flat = flat_film_direction(mesh, use);
    const std::vector<PatchVertex> patch = patch_around(mesh, corners, use.face, rings);
    if (patch.size() < kEnoughPoints) return flat;

    const Triangle x = triangle(mesh, use.face);
    const Vec3 edge = opposite_edge(x, use.opposite);
    const Vec3 middle = 0.5 * (x[(use.opposite + 1) % 3] + x[(use.opposite + 2) % 3]);
    const Vec3 along = direction(edge);
    const Vec3 normal = direction(doubled_area_vector(x));
    std::vector<Vec3> points;
    for (const PatchVertex& vertex : patch) {
        const Vec3 r = vertex.at - middle;
        points.push_back({{dot(r, along), dot(r, flat), dot(r, normal)}});
    }
    const auto slope = quadratic_slope(points, norm(edge));
    // The patch is tangent to along + slope_u normal and to flat + slope_v normal. Its tangent perpendicular to the
    // edge is the second one to first order in slope_u, which vanishes like h^2.
    return slope ? direction(flat + (*slope)[1] * normal) : flat;
}

}  // namespace lamella::mesh::detail
