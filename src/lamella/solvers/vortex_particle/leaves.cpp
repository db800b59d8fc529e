#include "lamella/solvers/vortex_particle/leaves.h"

#include "lamella/core/error.h"
#include "lamella/mesh/edge_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lamella::vortex_particle {
namespace {

using mesh::RegionId;
using mesh::RegionKind;

constexpr std::uint32_t kNoLeaf = 0xffffffffU;
/// The leaves of each face: of the region behind and of that in front.
using FaceLeaves = std::vector<std::array<std::uint32_t, 2>>;

FaceLeaves lay_triangles(const mesh::FoamMesh& mesh, Surface& s, std::vector<std::array<std::uint32_t, 3>>& sites) {
    FaceLeaves leaves;
    const auto closed = [&](RegionId r) { return mesh.regions[r].kind == RegionKind::kClosed; };
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const mesh::Face& face = mesh.faces.values()[f];
        auto& mine = leaves.emplace_back(std::array<std::uint32_t, 2>{kNoLeaf, kNoLeaf});
        const bool both = closed(face.back) && closed(face.front);
        for (const std::uint32_t side : {0U, 1U}) {
            const RegionId r = side == 0 ? face.back : face.front;
            const bool open = side == 0 && !closed(face.back) && !closed(face.front);
            if (!open && !closed(r)) continue;
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t k = 0; k < 3; ++k) corners[k] = static_cast<std::uint32_t>(index(face.vertices[k]));
            if (side == 1) std::swap(corners[1], corners[2]);
            mine[side] = static_cast<std::uint32_t>(s.film.size());
            sites.push_back(corners);
            s.film.push_back(f);
            s.side.push_back(static_cast<std::uint8_t>(side));
            s.region.push_back(open ? kNoRegion : static_cast<std::uint32_t>(index(r)));
            s.share.push_back(both ? 0.5 : 1.0);
        }
    }
    for (std::size_t t = 0; t < s.film.size(); ++t) s.partner.push_back(leaves[s.film[t]][1U - s.side[t]]);
    for (std::uint32_t& partner : s.partner)
        if (partner == kNoLeaf) partner = kNoPartner;
    return leaves;
}

/// One vertex for each vertex of the mesh and region with leaves there.
void lay_vertices(const mesh::FoamMesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& sites, Surface& s) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
    for (std::size_t t = 0; t < sites.size(); ++t)
        for (const std::uint32_t site : sites[t]) all.emplace_back(site, s.region[t]);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const auto& [site, region] : all) {
        s.site.push_back(site);
        s.position.push_back(mesh.position.values()[site]);
    }
    s.corner.resize(sites.size());
    for (std::size_t t = 0; t < sites.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            s.corner[t][k] = static_cast<std::uint32_t>(
                std::lower_bound(all.begin(), all.end(), std::pair{sites[t][k], s.region[t]}) - all.begin());
}

/// A leaf at an edge.
struct Use {
    std::uint32_t triangle;
    std::uint32_t opposite;  ///< its corner that is not on the edge
    bool forward;            ///< it runs from a to b
    double angle = 0.0;      ///< around the edge, from a to b, counterclockwise
};

/// Where a bubble touches an edge more than once, its wedges lie apart: each leaf with the bubble on its
/// counterclockwise side goes on in the next one.
void pair_by_wedges(const Surface& s, std::vector<Use>& uses) {
    const auto across = [&](const Use& use) {
        const std::uint32_t tip = s.corner[use.triangle][use.opposite];
        const Vec3 along = use.forward ? s.edge(use.triangle, use.opposite) : -s.edge(use.triangle, use.opposite);
        const Vec3 unit = along / norm(along);
        const Vec3 from = s.position[tip] - s.position[s.corner[use.triangle][(use.opposite + 1) % 3]];
        return std::pair{unit, from - dot(from, unit) * unit};
    };
    const auto [axis, first] = across(uses[0]);
    const Vec3 second = cross(axis, first);
    for (Use& use : uses)
        use.angle =
            std::atan2(dot(across(use).second, second), dot(across(use).second, first) * norm(second) / norm(first));
    std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
        return std::pair{a.angle, a.triangle} < std::pair{b.angle, b.triangle};
    });
    // A leaf that runs along the edge has its normal on its counterclockwise side, and its bubble on the other.
    if (uses[0].forward) std::rotate(uses.begin(), uses.begin() + 1, uses.end());
}

void join(Surface& s, const Use& a, const Use& b) {
    s.neighbor[a.triangle][a.opposite] = static_cast<std::int32_t>(b.triangle);
    s.neighbor[b.triangle][b.opposite] = static_cast<std::int32_t>(a.triangle);
}

}  // namespace

void lay_leaves(const mesh::FoamMesh& mesh, Surface& s) {
    std::vector<std::array<std::uint32_t, 3>> sites;
    const FaceLeaves leaves = lay_triangles(mesh, s, sites);
    lay_vertices(mesh, sites, s);
    s.neighbor.assign(s.triangles(), {kNoNeighbor, kNoNeighbor, kNoNeighbor});
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    std::vector<Use> all;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        all.clear();
        for (const mesh::EdgeUse& use : edges.of(e))
            for (const std::uint32_t side : {0U, 1U}) {
                const std::uint32_t t = leaves[index(use.face)][side];
                if (t == kNoLeaf) continue;
                // A leaf of the region in front has its second and third corner exchanged.
                const std::uint32_t opposite = side == 0 || use.opposite == 0 ? use.opposite : 3 - use.opposite;
                all.push_back({t, opposite, use.forward == (side == 0)});
            }
        std::stable_sort(all.begin(), all.end(),
                         [&](const Use& a, const Use& b) { return s.region[a.triangle] < s.region[b.triangle]; });
        for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
            while (end < all.size() && s.region[all[end].triangle] == s.region[all[begin].triangle]) ++end;
            std::vector<Use> uses(all.begin() + static_cast<std::ptrdiff_t>(begin),
                                  all.begin() + static_cast<std::ptrdiff_t>(end));
            if (uses.size() == 1) continue;
            if (s.region[uses[0].triangle] == kNoRegion) {
                if (uses.size() > 2)
                    throw InputError(
                        "vortex_particle: films that bound no bubble and meet in a triple line need junction = \"sheets\"");
                if (uses[0].forward == uses[1].forward)
                    throw InputError(
                        "vortex_particle: neighboring triangles of the film face opposite ways; turn its faces to "
                        "one side");
            } else if (uses.size() > 2) {
                pair_by_wedges(s, uses);
            }
            for (std::size_t k = 0; k + 1 < uses.size(); k += 2) join(s, uses[k], uses[k + 1]);
        }
    }
}

}  // namespace lamella::vortex_particle
