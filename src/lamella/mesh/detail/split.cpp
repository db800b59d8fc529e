#include "lamella/mesh/detail/candidate_edges.h"
#include "lamella/mesh/detail/face_shape.h"
#include "lamella/mesh/detail/workbench.h"

#include <functional>

namespace lamella::mesh::detail {
namespace {

/// Edges longer than allowed, or opposite a very wide angle; longest first.
std::vector<CandidateEdge> long_edges(const Workbench& bench) {
    static const double kWide = cot_of_degrees(157.0);
    const EditMesh& mesh = bench.mesh;
    const double longest = bench.length(bench.options.longest_edge);
    const double opposite_wide = bench.length(0.9);
    return candidate_edges(
        mesh,
        [&](double squared, VertexId v, VertexId w, VertexId opposite) {
            if (squared > longest * longest) return true;
            return squared >= opposite_wide * opposite_wide &&
                   cot_at(mesh.at(opposite), mesh.at(v), mesh.at(w)) <= kWide;
        },
        std::greater<>());
}

/// Every face of the edge becomes two. No volume changes and nothing can intersect, but for the rounding of the middle: a face so
/// thin that it would feel that is left as it is. @returns whether it was done
bool split(Workbench& bench, VertexId v, VertexId w) {
    constexpr double kThinnest = 1e9;  // length over height
    EditMesh& mesh = bench.mesh;
    for (const FaceId f : mesh.faces_on(v, w))
        if (!(sharpest_cot(mesh.corners(f)) < kThinnest)) return false;
    mesh.begin();
    const VertexId middle = mesh.add_vertex(0.5 * (mesh.at(v) + mesh.at(w)), false);
    for (const FaceId f : mesh.faces_on(v, w)) {
        Face near_v = mesh.face(f);
        Face near_w = near_v;
        for (std::size_t k = 0; k < 3; ++k) {
            if (near_v.vertices[k] == w) near_v.vertices[k] = middle;
            if (near_w.vertices[k] == v) near_w.vertices[k] = middle;
        }
        mesh.set_face(f, near_v);
        mesh.add_face(near_w);
    }
    mesh.commit();
    bench.resample(middle, {v, w}, {0.5, 0.5});
    ++bench.report.splits;
    return true;
}

}  // namespace

void split_long_edges(Workbench& bench) {
    constexpr int kMostPasses = 12;  // each halves what is too long; motion needs one, a coarse start a few
    for (int pass = 0; pass < kMostPasses; ++pass) {
        bool any = false;
        for (const CandidateEdge& edge : long_edges(bench)) {
            if (bench.mesh.faces_on(edge.v, edge.w).empty()) continue;
            any = split(bench, edge.v, edge.w) || any;
        }
        if (!any) return;
    }
}

}  // namespace lamella::mesh::detail
