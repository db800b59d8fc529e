#include "lamella/mesh/subdivide.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace lamella::mesh {
namespace {

/// The middle of the arc from a to b of the circle through c, a and b; nothing where the wire turns by 60 degrees (a
/// regular hexagon, whatever the rounding) or more from one edge to the next: a corner.
std::optional<Vec3> arc_middle(const Vec3& c, const Vec3& a, const Vec3& b) {
    const Vec3 chord = b - a;
    const Vec3 before = a - c;
    if (dot(chord, before) < 0.501 * norm(chord) * norm(before)) return std::nullopt;
    // With the center m + s d, d the unit vector in the plane perpendicular to the chord, away from c.
    const Vec3 middle = 0.5 * (a + b);
    const double length = norm(chord);
    const Vec3 along = chord / length;
    const Vec3 from = c - middle;
    const double x = dot(from, along);
    const Vec3 off = from - x * along;
    const double y = norm(off);
    if (y < 1e-12 * length) return middle;  // straight
    const Vec3 d = off / y;
    const double half = 0.5 * length;
    const double center = (x * x + y * y - half * half) / (2.0 * y);  // along d, toward c; the center of the circle
    const double radius = std::sqrt(center * center + half * half);
    return middle + (center - std::copysign(radius, center)) * d;
}

/// For each wire vertex its two neighbors along the wire, where it has two.
struct WireNeighbors {
    IdVector<VertexId, std::array<VertexId, 2>> of;
    VertexId beyond(VertexId v, VertexId except) const {
        const auto& [p, q] = of[v];
        if (p == kNoVertex || q == kNoVertex) return kNoVertex;
        return p == except ? q : q == except ? p : kNoVertex;
    }
};

WireNeighbors wire_neighbors(const FoamMesh& mesh, const EdgeFaces& edges) {
    constexpr std::array<VertexId, 2> kNobody{kNoVertex, kNoVertex};
    WireNeighbors neighbors{IdVector<VertexId, std::array<VertexId, 2>>(mesh.position.size(), kNobody)};
    IdVector<VertexId, int> count(mesh.position.size(), 0);
    const auto add = [&](VertexId v, VertexId w) {
        const int n = count[v]++;
        if (n < 2) neighbors.of[v][static_cast<std::size_t>(n)] = w;
        if (n == 2) neighbors.of[v] = kNobody;  // wires meet here
    };
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (is_wire_edge(mesh, edges, e)) {
            add(edges.edge[e].a, edges.edge[e].b);
            add(edges.edge[e].b, edges.edge[e].a);
        }
    return neighbors;
}

}  // namespace

bool is_wire_edge(const FoamMesh& mesh, const EdgeFaces& edges, std::size_t e) {
    return mesh.on_wire[edges.edge[e].a] != 0 && mesh.on_wire[edges.edge[e].b] != 0 && edges.of(e).size() != 2;
}

std::vector<Vec3> edge_middles(const FoamMesh& mesh, const EdgeFaces& edges) {
    const WireNeighbors wires = wire_neighbors(mesh, edges);
    std::vector<Vec3> middles(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b, shift] = edges.edge[e];
        middles[e] = mesh.position[a] + 0.5 * edge_vector(mesh, edges.of(e)[0]);
        if (!is_wire_edge(mesh, edges, e)) continue;
        Vec3 sum;
        int count = 0;
        for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
            const VertexId c = wires.beyond(from, to);
            if (c == kNoVertex) continue;
            if (const auto place = arc_middle(mesh.position[c], mesh.position[from], mesh.position[to])) {
                sum += *place;
                ++count;
            }
        }
        if (count == 2) middles[e] = 0.5 * sum;
    }
    return middles;
}

FoamMesh subdivide(const FoamMesh& mesh, const EdgeFaces& edges, const std::vector<Vec3>& middles) {
    FoamMesh fine;
    fine.position = mesh.position;
    fine.on_wire = mesh.on_wire;
    fine.regions = mesh.regions;
    fine.period = mesh.period;
    IdVector<FaceId, std::array<VertexId, 3>> middle(mesh.faces.size());      // of the edge from corner k to k + 1
    IdVector<FaceId, CornerImages> image(mesh.periodic() ? mesh.faces.size() : 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const VertexId m = fine.add_vertex(middles[e], is_wire_edge(mesh, edges, e));
        for (const EdgeUse& use : edges.of(e)) {
            const std::size_t tail = (use.opposite + 1) % 3;
            middle[use.face][tail] = m;
            if (mesh.periodic()) image[use.face][tail] = mesh.images[use.face][use.forward ? tail : (tail + 1) % 3];
        }
    }
    for (const FaceId f : mesh.faces.ids()) {
        const auto [vertices, back, front] = mesh.faces[f];
        const auto& m = middle[f];
        for (std::size_t k = 0; k < 3; ++k) fine.add_face(vertices[k], m[k], m[(k + 2) % 3], back, front);
        fine.add_face(m[0], m[1], m[2], back, front);
        if (!mesh.periodic()) continue;
        for (std::size_t k = 0; k < 3; ++k)
            fine.images.push_back({mesh.images[f][k], image[f][k], image[f][(k + 2) % 3]});
        fine.images.push_back(image[f]);
    }
    return fine;
}

}  // namespace lamella::mesh
