#include "lamella/solvers/equilibrium/patch_angles.h"

#include "lamella/geometry/curved_triangle.h"
#include "lamella/mesh/subdivide.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lamella::equilibrium {
namespace {

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

/// Direction in which a patch leaves the middle of its edge, perpendicular to the edge.
Vec3 conormal(const Patches& patches, const mesh::EdgeUse& use) {
    return geometry::edge_conormal(patches.corners(index(use.face)), use.opposite);
}

void add_films(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, const Patches& patches, PatchAngles& result) {
    constexpr double kLaw = 2.0943951023931953;  // 120 degrees
    double weight = 0.0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto uses = edges.of(e);
        if (uses.size() != 3 || mesh::is_wire_edge(mesh, edges, e)) continue;
        const std::array<Vec3, 3> out{conormal(patches, uses[0]), conormal(patches, uses[1]),
                                      conormal(patches, uses[2])};
        const std::size_t tail = (uses[0].opposite + 1) % 3, head = (tail + 1) % 3;
        const std::array<Vec3, 6> x = patches.corners(index(uses[0].face));
        const double length = norm(x[head] - x[tail]);
        PatchAngles::Film film{e, 0.0};
        for (std::size_t k = 0; k < 3; ++k) {
            const double off = std::abs(angle_between(out[k], out[(k + 1) % 3]) - kLaw);
            result.films.mean += length * off / 3.0;
            film.error = std::max(film.error, off);
        }
        result.films.largest = std::max(result.films.largest, film.error);
        result.film.push_back(film);
        weight += length;
    }
    if (weight > 0.0) result.films.mean /= weight;
}

void add_junctions(const mesh::FoamMesh& mesh, const Patches& patches, PatchAngles& result) {
    IdVector<mesh::FaceId, geometry::CurvedTriangle> curved;
    for (std::size_t p = 0; p < patches.size(); ++p) curved.push_back(patches.corners(p));
    std::vector<mesh::JunctionAngles> junctions = mesh::junction_angles(mesh, curved);
    std::erase_if(junctions, [&](const mesh::JunctionAngles& j) {
        return j.angle.size() != 6 || patches.fixed[index(j.vertex)] != 0;  // no proper junction, or on a wire
    });
    result.junctions = mesh::deviation_from_plateau(junctions);
    for (const mesh::JunctionAngles& j : junctions)
        result.junction.push_back({j.vertex, mesh::deviation_from_plateau(std::vector{j}).largest});
}

}  // namespace

PatchAngles patch_angles(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, const Patches& patches) {
    PatchAngles result;
    add_films(mesh, edges, patches, result);
    add_junctions(mesh, patches, result);
    return result;
}

}  // namespace lamella::equilibrium
