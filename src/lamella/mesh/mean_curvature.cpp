#include "lamella/mesh/mean_curvature.h"

#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/detail/triangle.h"

#include <algorithm>
#include <cmath>

namespace lamella::mesh {
namespace {


bool touches(const FoamMesh& mesh, const EdgeUse& use, RegionId r) {
    return mesh.faces[use.face].back == r || mesh.faces[use.face].front == r;
}

/// Outward normal of region r on a face, of any length.
Vec3 outward(const FoamMesh& mesh, const EdgeUse& use, RegionId r) {
    const Vec3 normal = detail::doubled_area_vector(detail::triangle(mesh, use.face));
    return mesh.faces[use.face].back == r ? normal : -normal;
}

/// |e| theta for region r between two faces at an edge.
double bend(const FoamMesh& mesh, const EdgeUse& first, const EdgeUse& second, RegionId r) {
    Vec3 along = edge_vector(mesh, first);  // from a to b; r must be seen on the left of the first face
    if (first.forward != (mesh.faces[first.face].back == r)) along = -along;
    const double length = norm(along);
    const Vec3 n0 = outward(mesh, first, r);
    const Vec3 n1 = outward(mesh, second, r);
    return length * std::atan2(dot(cross(n0, n1), along) / length, dot(n0, n1));
}

std::vector<RegionId> regions_around(const FoamMesh& mesh, std::span<const EdgeUse> uses) {
    std::vector<RegionId> regions;
    for (const EdgeUse& use : uses) {
        regions.push_back(mesh.faces[use.face].back);
        regions.push_back(mesh.faces[use.face].front);
    }
    std::ranges::sort(regions);
    regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
    return regions;
}

}  // namespace

std::vector<EdgeCurvature> edge_mean_curvatures(const FoamMesh& mesh) {
    const EdgeFaces edges = edge_faces(mesh);
    std::vector<EdgeCurvature> curvatures;
    curvatures.reserve(2 * edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
        for (const RegionId r : regions_around(mesh, edges.of(e))) {
            std::vector<EdgeUse> sides;
            std::ranges::copy_if(edges.of(e), std::back_inserter(sides),
                                 [&](const EdgeUse& use) { return touches(mesh, use, r); });
            if (sides.size() == 2)
                curvatures.push_back({edges.edge[e].a, edges.edge[e].b, r, bend(mesh, sides[0], sides[1], r)});
        }
    return curvatures;
}

VertexCurvature vertex_mean_curvatures(const FoamMesh& mesh) {
    VertexCurvature curvature{vertex_regions(mesh), {}};
    curvature.value.resize(curvature.entries.region.size());
    for (const EdgeCurvature& edge : edge_mean_curvatures(mesh))
        for (const VertexId v : {edge.a, edge.b})
            curvature.value[*curvature.entries.find(v, edge.region)] += 0.5 * edge.value;
    return curvature;
}

}  // namespace lamella::mesh
