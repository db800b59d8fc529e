#include "lamella/solvers/equilibrium/patches.h"

#include "lamella/core/id_vector.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lamella::equilibrium {
namespace {

using mesh::FaceId;
using mesh::FoamMesh;
using mesh::VertexId;

double tension_between(mesh::RegionId back, mesh::RegionId front, const std::vector<FilmTension>& tension) {
    for (const FilmTension& t : tension)
        if ((t.a == back && t.b == front) || (t.a == front && t.b == back)) return t.factor;
    return 1.0;
}

/// The middle of the arc from a to b of the circle through c, a and b; nothing where the wire turns by more than 60
/// degrees from one edge to the next: a corner.
std::optional<Vec3> arc_middle(const Vec3& c, const Vec3& a, const Vec3& b) {
    const Vec3 chord = b - a;
    const Vec3 before = a - c;
    if (dot(chord, before) < 0.5 * norm(chord) * norm(before)) return std::nullopt;
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
        if (p == mesh::kNoVertex || q == mesh::kNoVertex) return mesh::kNoVertex;
        return p == except ? q : q == except ? p : mesh::kNoVertex;
    }
};

bool is_wire_edge(const FoamMesh& mesh, const mesh::EdgeFaces& edges, std::size_t e) {
    return mesh.on_wire[edges.edge[e].a] != 0 && mesh.on_wire[edges.edge[e].b] != 0 && edges.of(e).size() != 2;
}

WireNeighbors wire_neighbors(const FoamMesh& mesh, const mesh::EdgeFaces& edges) {
    constexpr std::array<VertexId, 2> kNobody{mesh::kNoVertex, mesh::kNoVertex};
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

Patches flat_patches(const FoamMesh& mesh, const std::vector<FilmTension>& tension) {
    Patches patches;
    patches.position = mesh.position.values();
    patches.fixed = mesh.on_wire.values();
    for (const FaceId f : mesh.faces.ids()) {
        const mesh::Face& face = mesh.faces[f];
        std::array<std::uint32_t, 6> nodes{};
        std::array<Vec3, 6> shift{};
        for (std::size_t k = 0; k < 3; ++k) {
            nodes[k] = static_cast<std::uint32_t>(index(face.vertices[k]));
            shift[k] = mesh.corner(f, k) - mesh.position[face.vertices[k]];
        }
        patches.nodes.push_back(nodes);
        if (mesh.periodic()) patches.shift.push_back(shift);
        patches.back.push_back(face.back);
        patches.front.push_back(face.front);
        patches.tension.push_back(tension_between(face.back, face.front, tension));
    }
    return patches;
}

std::vector<Vec3> edge_middles(const FoamMesh& mesh, const mesh::EdgeFaces& edges) {
    const WireNeighbors wires = wire_neighbors(mesh, edges);
    std::vector<Vec3> middles(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b, shift] = edges.edge[e];
        middles[e] = mesh.position[a] + 0.5 * mesh::edge_vector(mesh, edges.of(e)[0]);
        if (!is_wire_edge(mesh, edges, e)) continue;
        Vec3 sum;
        int count = 0;
        for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
            const VertexId c = wires.beyond(from, to);
            if (c == mesh::kNoVertex) continue;
            if (const auto place = arc_middle(mesh.position[c], mesh.position[from], mesh.position[to])) {
                sum += *place;
                ++count;
            }
        }
        if (count == 2) middles[e] = 0.5 * sum;
    }
    return middles;
}

Patches quadratic_patches(const FoamMesh& mesh,
                          const mesh::EdgeFaces& edges,
                          const std::vector<FilmTension>& tension) {
    Patches patches = flat_patches(mesh, tension);
    patches.nodes_per_patch = 6;
    const auto first = patches.position.size();
    const std::vector<Vec3> middles = edge_middles(mesh, edges);
    patches.position.insert(patches.position.end(), middles.begin(), middles.end());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        patches.fixed.push_back(is_wire_edge(mesh, edges, e) ? 1 : 0);
        for (const mesh::EdgeUse& use : edges.of(e)) {
            const std::size_t tail = (use.opposite + 1) % 3;  // node 3 + k lies between corners k and k + 1
            const std::size_t f = index(use.face);
            patches.nodes[f][3 + tail] = static_cast<std::uint32_t>(first + e);
            // The middle lies next to the image of the edge's vertex a that this face has.
            if (mesh.periodic()) patches.shift[f][3 + tail] = patches.shift[f][use.forward ? tail : (tail + 1) % 3];
        }
    }
    return patches;
}

}  // namespace lamella::equilibrium
