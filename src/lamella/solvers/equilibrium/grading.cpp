#include "lamella/solvers/equilibrium/grading.h"

#include "lamella/core/error.h"
#include "lamella/geometry/curved_triangle.h"

#include <array>
#include <utility>

namespace lamella::equilibrium {
namespace {

using mesh::CornerImages;
using mesh::EdgeFaces;
using mesh::EdgeUse;
using mesh::FaceId;
using mesh::FoamMesh;
using mesh::kNoVertex;
using mesh::VertexId;

/// A corner of a piece: vertex, image, and where it lies in its patch.
struct Corner {
    VertexId vertex;
    std::array<std::int8_t, 3> image{};
    std::array<double, 3> weight{};
};

std::array<double, 3> between(const Corner& a, const Corner& b) {
    std::array<double, 3> middle;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = 0.5 * (a.weight[k] + b.weight[k]);
    return middle;
}

/// Cuts the faces one by one and notes where the middles of the new edges lie.
class Cut {
public:
    Cut(const FoamMesh& mesh, const EdgeFaces& edges, const Patches& patches,
        const IdVector<VertexId, std::uint8_t>& marked)
        : mesh_(mesh), patches_(patches), halves_(mesh.faces.size(), {kNoVertex, kNoVertex, kNoVertex}),
          half_images_(mesh.faces.size()) {
        fine.position = mesh.position;
        for (const VertexId v : fine.position.ids()) fine.position[v] = patches.position[index(v)];
        fine.on_wire = mesh.on_wire;
        fine.regions = mesh.regions;
        fine.period = mesh.period;
        halve_edges(edges, marked);
        for (const FaceId f : mesh.faces.ids()) cut(f);
    }

    FoamMesh fine;
    std::vector<std::array<Vec3, 3>> middles;  ///< per new face: between corners k and k + 1, seen from the face

private:
    void halve_edges(const EdgeFaces& edges, const IdVector<VertexId, std::uint8_t>& marked) {
        for (std::size_t e = 0; e < edges.size(); ++e) {
            if (!marked[edges.edge[e].a] && !marked[edges.edge[e].b]) continue;
            const VertexId middle = fine.add_vertex(patches_.position[mesh_.position.size() + e]);
            for (const EdgeUse& use : edges.of(e)) {
                const std::size_t tail = (use.opposite + 1) % 3;
                halves_[use.face][tail] = middle;
                if (mesh_.periodic())
                    half_images_[use.face][tail] = mesh_.images[use.face][use.forward ? tail : (tail + 1) % 3];
            }
        }
    }

    Corner corner(FaceId f, std::size_t k) const {
        Corner c{mesh_.faces[f].vertices[k]};
        if (mesh_.periodic()) c.image = mesh_.images[f][k];
        c.weight[k] = 1.0;
        return c;
    }

    Corner half(FaceId f, std::size_t k) const {
        Corner c{halves_[f][k]};
        if (mesh_.periodic()) c.image = half_images_[f][k];
        c.weight[k] = c.weight[(k + 1) % 3] = 0.5;
        return c;
    }

    void add(FaceId f, const Corner& a, const Corner& b, const Corner& c) {
        const auto& [vertices, back, front] = mesh_.faces[f];
        fine.add_face(a.vertex, b.vertex, c.vertex, back, front);
        if (mesh_.periodic()) fine.images.push_back({a.image, b.image, c.image});
        const geometry::CurvedTriangle x = patches_.corners(index(f));
        middles.push_back({geometry::point_on(x, between(a, b)), geometry::point_on(x, between(b, c)),
                           geometry::point_on(x, between(c, a))});
    }

    /// A face has no, two or three halved edges: those that end at its marked corners.
    void cut(FaceId f) {
        const auto& h = halves_[f];
        std::size_t whole = 0, count = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            if (h[k] == kNoVertex) whole = k;
            else ++count;
        }
        if (count == 0) return add(f, corner(f, 0), corner(f, 1), corner(f, 2));
        if (count == 3) {
            for (std::size_t k = 0; k < 3; ++k) add(f, corner(f, k), half(f, k), half(f, (k + 2) % 3));
            return add(f, half(f, 0), half(f, 1), half(f, 2));
        }
        LAMELLA_ASSERT(count == 2);
        const std::size_t a = whole, b = (whole + 1) % 3, c = (whole + 2) % 3;  // c is marked
        const Corner at_b = half(f, b), at_c = half(f, c);                      // between b and c, between c and a
        add(f, corner(f, c), at_c, at_b);
        add(f, at_c, corner(f, a), at_b);
        add(f, at_b, corner(f, a), corner(f, b));
    }

    const FoamMesh& mesh_;
    const Patches& patches_;
    IdVector<FaceId, std::array<VertexId, 3>> halves_;  ///< in the middle of the edge from corner k to k + 1
    IdVector<FaceId, CornerImages> half_images_;
};

}  // namespace

Graded grade(const FoamMesh& mesh,
             const EdgeFaces& edges,
             const Patches& patches,
             const IdVector<VertexId, std::uint8_t>& marked,
             const std::vector<FilmTension>& tension) {
    Cut cut(mesh, edges, patches, marked);
    Graded graded{std::move(cut.fine), {}, {}};
    graded.edges = mesh::edge_faces(graded.mesh);
    graded.patches = quadratic_patches(graded.mesh, graded.edges, tension);
    for (std::size_t p = 0; p < graded.patches.size(); ++p)
        for (std::size_t k = 3; k < 6; ++k) {
            const Vec3 shift = graded.patches.shift.empty() ? Vec3{} : graded.patches.shift[p][k];
            graded.patches.position[graded.patches.nodes[p][k]] = cut.middles[p][k - 3] - shift;
        }
    return graded;
}

IdVector<VertexId, std::uint8_t> junctions(const FoamMesh& mesh, const EdgeFaces& edges) {
    IdVector<VertexId, std::uint8_t> lines(mesh.position.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (edges.of(e).size() == 3)
            for (const VertexId v : {edges.edge[e].a, edges.edge[e].b})
                if (lines[v] < 5) ++lines[v];
    for (const VertexId v : lines.ids()) lines[v] = lines[v] == 4 && !mesh.on_wire[v] ? 1 : 0;
    return lines;
}

}  // namespace lamella::equilibrium
