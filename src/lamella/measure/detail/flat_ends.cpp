#include "lamella/measure/detail/flat_ends.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella::measure::detail {
namespace {

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::VertexId;

using Edge = std::pair<VertexId, VertexId>;

/// Edges of closed regions' surfaces, in the direction of their triangles with normals outward, that no other triangle
/// of the region runs along backward.
std::map<RegionId, std::vector<Edge>> open_edges(const FoamMesh& mesh) {
    struct Run {
        RegionId region;
        VertexId low, high;
        int forward;  // 1: from low to high, -1: back
    };
    std::vector<Run> runs;
    runs.reserve(3 * mesh.faces.size());
    const auto add = [&](RegionId region, VertexId from, VertexId to) {
        if (mesh.regions[region].kind != mesh::RegionKind::kClosed) return;
        runs.push_back({region, std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    };
    for (const mesh::Face& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            add(face.back, face.vertices[k], face.vertices[(k + 1) % 3]);
            add(face.front, face.vertices[(k + 1) % 3], face.vertices[k]);
        }
    const auto key = [](const Run& run) { return std::tie(run.region, run.low, run.high); };
    std::sort(runs.begin(), runs.end(), [&](const Run& a, const Run& b) { return key(a) < key(b); });
    std::map<RegionId, std::vector<Edge>> open;
    for (std::size_t first = 0, last = 0; first < runs.size(); first = last) {
        int forward = 0;
        for (; last < runs.size() && key(runs[last]) == key(runs[first]); ++last) forward += runs[last].forward;
        const Run& run = runs[first];
        if (forward > 0) open[run.region].push_back({run.low, run.high});
        if (forward < 0) open[run.region].push_back({run.high, run.low});
    }
    return open;
}

/// A vertex for each vertex of the edges, the same for all of a loop.
std::map<VertexId, VertexId> loops_of(const std::vector<Edge>& edges) {
    std::map<VertexId, VertexId> loop;
    const auto root = [&](VertexId v) {
        while (loop.at(v) != v) v = loop.at(v);
        return v;
    };
    for (const auto& [a, b] : edges) {
        loop.try_emplace(a, a);
        loop.try_emplace(b, b);
        const VertexId p = root(a), q = root(b);
        loop[std::max(p, q)] = std::min(p, q);
    }
    for (auto& [v, to] : loop) to = root(v);
    return loop;
}

void close(FoamMesh& mesh, RegionId region, const std::vector<Edge>& edges) {
    const std::map<VertexId, VertexId> loop = loops_of(edges);
    std::map<VertexId, std::pair<Vec3, double>> sum;  // of each loop's vertices
    for (const auto& [v, of] : loop) {
        sum[of].first += mesh.position[v];
        sum[of].second += 1.0;
    }
    std::map<VertexId, VertexId> middle;
    for (const auto& [of, s] : sum) middle[of] = mesh.add_vertex(s.first / s.second);
    for (const auto& [a, b] : edges) mesh.add_face(b, a, middle.at(loop.at(a)), region, mesh::kOutside);
}

}  // namespace

std::optional<FoamMesh> with_flat_ends(const FoamMesh& mesh) {
    if (mesh.periodic()) return std::nullopt;
    const std::map<RegionId, std::vector<Edge>> open = open_edges(mesh);
    if (open.empty()) return std::nullopt;
    FoamMesh whole = mesh;
    for (const auto& [region, edges] : open) close(whole, region, edges);
    return whole;
}

}  // namespace lamella::measure::detail
