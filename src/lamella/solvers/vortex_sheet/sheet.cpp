#include "lamella/solvers/vortex_sheet/sheet.h"

#include "lamella/core/parallel.h"
#include "lamella/mesh/edge_faces.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace lamella::vortex_sheet {
namespace {

using mesh::FaceId;
using mesh::FoamMesh;
using mesh::RegionId;
using mesh::VertexId;

/// Whether a film ends at an edge: what the faces around it take away from their regions does not come back.
bool is_rim(const FoamMesh& mesh, std::span<const mesh::EdgeUse> uses) {
    std::map<RegionId, int> balance;
    for (const mesh::EdgeUse& use : uses) {
        const int sign = use.forward ? 1 : -1;
        balance[mesh.faces[use.face].back] += sign;
        balance[mesh.faces[use.face].front] -= sign;
    }
    return std::any_of(balance.begin(), balance.end(), [](const auto& b) { return b.second != 0; });
}

IdVector<VertexId, Hold> holds(const FoamMesh& mesh) {
    IdVector<VertexId, Hold> hold(mesh.position.size(), Hold::kFree);
    bool any = false;
    for (const VertexId v : hold.ids()) {
        if (mesh.on_wire[v] != 0) hold[v] = Hold::kPinned;
        any = any || mesh.on_wire[v] != 0;
    }
    if (!any) return hold;
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto& [a, b, shift] = edges.edge[e];
        if (mesh.on_wire[a] != 0 && mesh.on_wire[b] != 0 && is_rim(mesh, edges.of(e))) hold[a] = hold[b] = Hold::kRim;
    }
    return hold;
}

void find_clusters(const FoamMesh& mesh, SheetTopology& topology) {
    std::vector<std::uint32_t> parent(mesh.position.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const mesh::Face& face : mesh.faces)
        for (const std::size_t k : {1U, 2U}) {
            const std::uint32_t a = root(static_cast<std::uint32_t>(face.vertices[0]));
            const std::uint32_t b = root(static_cast<std::uint32_t>(face.vertices[k]));
            parent[std::max(a, b)] = std::min(a, b);
        }
    topology.cluster.resize(mesh.position.size());
    for (const VertexId v : mesh.position.ids()) {
        const std::uint32_t r = root(static_cast<std::uint32_t>(v));
        topology.cluster[v] =
            r == static_cast<std::uint32_t>(v) ? topology.clusters++ : topology.cluster[static_cast<VertexId>(r)];
    }
}

}  // namespace

SheetTopology sheet_topology(const FoamMesh& mesh) {
    SheetTopology topology;
    topology.corners = mesh::vertex_corners(mesh);
    topology.entries = mesh::vertex_regions(mesh, topology.corners);
    topology.entry.resize(mesh.faces.size());
    parallel_for(mesh.faces.size(), [&](std::size_t i) {
        const auto f = static_cast<FaceId>(i);
        const mesh::Face& face = mesh.faces[f];
        for (std::size_t k = 0; k < 3; ++k)
            topology.entry[f][k] = {static_cast<std::uint32_t>(*topology.entries.find(face.vertices[k], face.back)),
                                    static_cast<std::uint32_t>(*topology.entries.find(face.vertices[k], face.front))};
    });
    topology.hold = holds(mesh);
    find_clusters(mesh, topology);
    return topology;
}

void fix_gauge(const SheetTopology& topology, Circulation& phi) {
    for (const VertexId v : topology.hold.ids()) {
        const std::size_t first = topology.first(v), last = topology.last(v);
        double mean = 0.0;
        for (std::size_t i = first; i < last; ++i) mean += phi[i];
        mean /= static_cast<double>(std::max<std::size_t>(1, last - first));
        for (std::size_t i = first; i < last; ++i) phi[i] -= mean;
    }
}

}  // namespace lamella::vortex_sheet
