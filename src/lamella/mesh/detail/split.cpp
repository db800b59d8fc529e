#include "lamella/mesh/detail/candidate_edges.h"
#include "lamella/mesh/detail/face_shape.h"
#include "lamella/mesh/detail/workbench.h"

#include <algorithm>
#include <functional>

namespace lamella::mesh::detail {
namespace {

/// Of a corner that lies on the edge opposite to it, as good as.
bool is_cap(const Vec3& corner, const Vec3& a, const Vec3& b) {
    static const double kFlat = cot_of_degrees(170.0);
    return cot_at(corner, a, b) <= kFlat;
}

/// Edges longer than allowed, opposite a very wide angle, or of a cap that no flip can mend; longest first.
std::vector<CandidateEdge> long_edges(const Workbench& bench) {
    static const double kWide = cot_of_degrees(157.0);
    const EditMesh& mesh = bench.mesh;
    const double longest = bench.length(bench.options.longest_edge);
    const double opposite_wide = bench.length(0.9);
    const double opposite_cap = bench.length(0.5);
    return candidate_edges(
        mesh,
        [&](double squared, VertexId v, VertexId w, VertexId opposite) {
            if (squared > longest * longest) return true;
            if (squared >= opposite_wide * opposite_wide && cot_at(mesh.at(opposite), mesh.at(v), mesh.at(w)) <= kWide)
                return true;
            return squared >= opposite_cap * opposite_cap && is_cap(mesh.at(opposite), mesh.at(v), mesh.at(w)) &&
                   mesh.faces_on(v, w).size() != 2;
        },
        std::greater<>());
}

/// Where to split, as a share of the way from v to w: the middle, or below the corner of a cap. There the film between
/// two triple lines has no width any more, and the collapse of what is left of it joins them.
double split_share(const EditMesh& mesh, VertexId v, VertexId w) {
    const Vec3 along = mesh.at(w) - mesh.at(v);
    for (const FaceId f : mesh.faces_on(v, w))
        for (const VertexId corner : mesh.face(f).vertices)
            if (corner != v && corner != w && is_cap(mesh.at(corner), mesh.at(v), mesh.at(w)))
                return std::clamp(dot(mesh.at(corner) - mesh.at(v), along) / squared_norm(along), 0.1, 0.9);
    return 0.5;
}

/// Every face of the edge becomes two. No volume changes and nothing can intersect, but for the rounding of the new
/// vertex: a face so thin that it would feel that is left as it is. @returns whether it was done
bool split(Workbench& bench, VertexId v, VertexId w) {
    constexpr double kThinnest = 1e9;  // length over height
    EditMesh& mesh = bench.mesh;
    for (const FaceId f : mesh.faces_on(v, w))
        if (!(sharpest_cot(mesh.corners(f)) < kThinnest)) return false;
    mesh.begin();
    const double share = split_share(mesh, v, w);
    const VertexId middle = mesh.add_vertex((1.0 - share) * mesh.at(v) + share * mesh.at(w), false);
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
    bench.resample(middle, {v, w}, {1.0 - share, share});
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
