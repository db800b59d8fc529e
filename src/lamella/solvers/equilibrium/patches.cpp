#include "lamella/solvers/equilibrium/patches.h"

#include "lamella/mesh/subdivide.h"

namespace lamella::equilibrium {
namespace {

using mesh::FaceId;
using mesh::FoamMesh;

double tension_between(mesh::RegionId back, mesh::RegionId front, const std::vector<FilmTension>& tension) {
    for (const FilmTension& t : tension)
        if ((t.a == back && t.b == front) || (t.a == front && t.b == back)) return t.factor;
    return 1.0;
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

Patches quadratic_patches(const FoamMesh& mesh,
                          const mesh::EdgeFaces& edges,
                          const std::vector<FilmTension>& tension) {
    Patches patches = flat_patches(mesh, tension);
    patches.nodes_per_patch = 6;
    const auto first = patches.position.size();
    const std::vector<Vec3> middles = mesh::edge_middles(mesh, edges);
    patches.position.insert(patches.position.end(), middles.begin(), middles.end());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        patches.fixed.push_back(mesh::is_wire_edge(mesh, edges, e) ? 1 : 0);
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
