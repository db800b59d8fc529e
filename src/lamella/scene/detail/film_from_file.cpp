#include "lamella/scene/detail/film_from_file.h"

#include "lamella/core/error.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/subdivide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella::scene::detail {
namespace {

using mesh::FoamMesh;
using mesh::VertexId;

constexpr double kMostFaces = 2e7;
constexpr double kLongestEdge = 1.45;  // of the wanted length: what trackers split

double area_of(const FoamMesh& mesh) {
    double area = 0.0;
    for (const mesh::FaceId f : mesh.faces.ids())
        area += 0.5 * norm(cross(mesh.corner(f, 1) - mesh.corner(f, 0), mesh.corner(f, 2) - mesh.corner(f, 0)));
    return area;
}

double mean_edge(const FoamMesh& mesh, const mesh::EdgeFaces& edges) {
    double sum = 0.0;
    for (std::size_t e = 0; e < edges.size(); ++e) sum += norm(edge_vector(mesh, edges.of(e)[0]));
    return sum / static_cast<double>(edges.size());
}

/// One round: long edges on wires, longest first, each face cut once at most. @returns  whether there were any
bool split_long_wires(FoamMesh& mesh, double longest) {
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    const auto length = [&](std::size_t e) { return norm(edge_vector(mesh, edges.of(e)[0])); };
    std::vector<std::size_t> order;
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (is_wire_edge(mesh, edges, e) && length(e) > longest) order.push_back(e);
    if (order.empty()) return false;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return length(a) > length(b); });
    const std::vector<Vec3> middles = mesh::edge_middles(mesh, edges);
    std::vector<std::uint8_t> cut(mesh.faces.size(), 0);
    for (const std::size_t e : order) {
        const auto uses = edges.of(e);
        if (std::any_of(uses.begin(), uses.end(), [&](const mesh::EdgeUse& u) { return cut[index(u.face)] != 0; })) continue;
        const VertexId m = mesh.add_vertex(middles[e], true);
        for (const mesh::EdgeUse& use : uses) {
            cut[index(use.face)] = 1;
            mesh::Face second = mesh.faces[use.face];
            mesh.faces[use.face].vertices[(use.opposite + 2) % 3] = m;
            second.vertices[(use.opposite + 1) % 3] = m;
            mesh.faces.push_back(second);
        }
    }
    return true;
}

}  // namespace

io::FilmFile scaled_films(const std::filesystem::path& path, double scale, const Vec3& center) {
    io::FilmFile films = io::read_films(path);
    if (scale == 1.0 && norm(center) == 0.0) return films;  // not a bit changes
    for (Vec3& x : films.mesh.position) x = scale * x + center;
    for (Vec3& period : films.mesh.period) period *= scale;
    for (mesh::Region& region : films.mesh.regions) region.target_volume *= scale * scale * scale;
    return films;
}

double edge_length_for(const FoamMesh& mesh) {
    double smallest = 0.0;
    for (const mesh::Region& r : mesh.regions)
        if (r.kind == mesh::RegionKind::kClosed && (smallest == 0.0 || r.target_volume < smallest))
            smallest = r.target_volume;
    constexpr double kPi = 3.14159265358979323846;
    if (smallest > 0.0) return 0.25 * std::cbrt(0.75 * smallest / kPi);
    Vec3 low = mesh.position[VertexId{0}], high = low;
    for (const Vec3& x : mesh.position)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], x[k]);
            high[k] = std::max(high[k], x[k]);
        }
    return 0.05 * std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

void refine_films(FoamMesh& mesh, double edge_length) {
    constexpr double kFacePerSquareEdge = 0.4330127018922193;  // sqrt(3) / 4
    if (!(area_of(mesh) < kMostFaces * kFacePerSquareEdge * edge_length * edge_length))
        throw InputError(fmt::format("edges of {:.3g} would give more than 2e7 faces", edge_length));
    for (;;) {
        const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
        if (!(mean_edge(mesh, edges) > 1.5 * edge_length)) break;
        if (4.0 * static_cast<double>(mesh.faces.size()) > kMostFaces)
            throw InputError(fmt::format("edges of {:.3g} would give more than 2e7 faces", edge_length));
        mesh = mesh::subdivide(mesh, edges, mesh::edge_middles(mesh, edges));
    }
    if (mesh.periodic()) return;
    while (split_long_wires(mesh, kLongestEdge * edge_length))
        if (static_cast<double>(mesh.faces.size()) > kMostFaces)
            throw InputError(fmt::format("edges of {:.3g} would give more than 2e7 faces", edge_length));
}

}  // namespace lamella::scene::detail
