#include "lamella/solvers/vortex_particle/sheets.h"

#include "lamella/core/error.h"
#include "lamella/mesh/edge_faces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace lamella::vortex_particle {
namespace {

/// One triangle for each face, seen from its region of the higher number: all of a film from one side.
std::vector<std::array<std::uint32_t, 3>> lay_triangles(const mesh::FoamMesh& mesh, Surface& s) {
    std::vector<std::array<std::uint32_t, 3>> sites;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const mesh::Face& face = mesh.faces.values()[f];
        const bool turned = index(face.back) > index(face.front);
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) corners[k] = static_cast<std::uint32_t>(index(face.vertices[k]));
        if (turned) std::swap(corners[1], corners[2]);
        sites.push_back(corners);
        s.film.push_back(f);
        s.side.push_back(turned ? 1 : 0);
        s.region.push_back(kNoRegion);
        s.share.push_back(1.0);
        s.partner.push_back(kNoPartner);
    }
    return sites;
}

/// The edges where a triangle has others beside it, opposite to which corner, and whether it runs from a to b.
struct Use {
    std::uint32_t triangle;
    std::uint32_t opposite;
    bool forward;
};

std::vector<Use> uses_of(const mesh::EdgeFaces& edges, std::size_t e, const Surface& s) {
    std::vector<Use> uses;
    for (const mesh::EdgeUse& use : edges.of(e)) {
        const auto t = static_cast<std::uint32_t>(index(use.face));
        const bool turned = s.side[t] == 1;
        uses.push_back({t, turned && use.opposite != 0 ? 3 - use.opposite : use.opposite, use.forward != turned});
    }
    return uses;
}

void join_neighbors(const mesh::EdgeFaces& edges, Surface& s) {
    s.neighbor.assign(s.triangles(), {kNoNeighbor, kNoNeighbor, kNoNeighbor});
    s.seam.assign(s.triangles(), {-1, -1, -1});
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const std::vector<Use> uses = uses_of(edges, e, s);
        if (uses.size() == 2) {
            if (uses[0].forward == uses[1].forward)
                throw InputError(
                    "vortex_particle: neighboring triangles of the film face opposite ways; turn its faces to one "
                    "side");
            for (const std::size_t i : {0U, 1U})
                s.neighbor[uses[i].triangle][uses[i].opposite] = static_cast<std::int32_t>(uses[1 - i].triangle);
        } else if (uses.size() > 2) {
            std::vector<Incidence> meeting;
            for (const Use& use : uses) {
                s.seam[use.triangle][use.opposite] = static_cast<std::int32_t>(s.seams.size());
                meeting.push_back({use.triangle, use.opposite});
            }
            s.seams.push_back(std::move(meeting));
        }
    }
}

/// Which film each triangle belongs to: the first triangle that can be reached without crossing a line.
std::vector<std::uint32_t> patches(const Surface& s) {
    std::vector<std::uint32_t> patch(s.triangles(), kNoPartner), queue;
    for (std::uint32_t first = 0; first < s.triangles(); ++first) {
        if (patch[first] != kNoPartner) continue;
        patch[first] = first;
        queue.assign(1, first);
        while (!queue.empty()) {
            const std::uint32_t t = queue.back();
            queue.pop_back();
            for (const std::int32_t n : s.neighbor[t]) {
                if (n == kNoNeighbor || patch[static_cast<std::size_t>(n)] != kNoPartner) continue;
                patch[static_cast<std::size_t>(n)] = first;
                queue.push_back(static_cast<std::uint32_t>(n));
            }
        }
    }
    return patch;
}

/// One vertex for each vertex of the mesh and film there.
void lay_vertices(const mesh::FoamMesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& sites, Surface& s) {
    const std::vector<std::uint32_t> patch = patches(s);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
    for (std::size_t t = 0; t < sites.size(); ++t)
        for (const std::uint32_t site : sites[t]) all.emplace_back(site, patch[t]);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (std::size_t v = 0; v < all.size(); ++v) {
        const bool first = v == 0 || all[v - 1].first != all[v].first;
        s.site.push_back(all[v].first);
        s.position.push_back(mesh.position.values()[all[v].first]);
        s.joint.push_back(first ? static_cast<std::uint32_t>(v) : s.joint.back());
    }
    for (std::size_t t = 0; t < sites.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            s.corner[t][k] = static_cast<std::uint32_t>(
                std::lower_bound(all.begin(), all.end(), std::pair{sites[t][k], patch[t]}) - all.begin());
}

}  // namespace

void lay_sheets(const mesh::FoamMesh& mesh, Surface& s) {
    const std::vector<std::array<std::uint32_t, 3>> sites = lay_triangles(mesh, s);
    s.corner.resize(sites.size());
    join_neighbors(mesh::edge_faces(mesh), s);
    lay_vertices(mesh, sites, s);
}

}  // namespace lamella::vortex_particle
