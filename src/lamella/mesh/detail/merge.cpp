#include "lamella/geometry/distance.h"
#include "lamella/mesh/detail/face_pairs.h"
#include "lamella/mesh/detail/face_shape.h"
#include "lamella/mesh/detail/sectors.h"
#include "lamella/mesh/detail/workbench.h"

#include <algorithm>
#include <cmath>

namespace lamella::mesh::detail {
namespace {

struct ClosePair {
    double squared_distance;
    FaceId f, g;  // f < g
};

/// Where a face is and looks.
struct Pose {
    Vec3 normal;  // of length 1
    Vec3 center;
};

Pose pose(const EditMesh& mesh, FaceId f) {
    const auto x = mesh.corners(f);
    const Vec3 n = area_vector(x);
    return {(1.0 / norm(n)) * n, (1.0 / 3.0) * (x[0] + x[1] + x[2])};
}

/// Some side of f and some side of g carry the same region, look at each other through it, and are nearly parallel.
bool face_each_other(const Face& a, const Pose& of_a, const Face& b, const Pose& of_b) {
    if (a.back != b.back && a.back != b.front && a.front != b.back && a.front != b.front) return false;
    const double cosine = dot(of_a.normal, of_b.normal);
    if (!(std::abs(cosine) > 0.75)) return false;
    const Vec3 between = of_b.center - of_a.center;
    for (const double side_a : {1.0, -1.0})
        for (const double side_b : {1.0, -1.0}) {
            const RegionId r = side_a > 0.0 ? a.front : a.back;
            if (r != (side_b > 0.0 ? b.front : b.back)) continue;
            if (side_a * side_b * cosine < -0.75 && side_a * dot(of_a.normal, between) > 0.0 &&
                side_b * dot(of_b.normal, between) < 0.0)
                return true;
        }
    return false;
}

/// Smallest squared distance between a vertex of one and the other, or between edges, counting only pairs that share
/// no vertex.
double squared_gap(const EditMesh& mesh, FaceId f, FaceId g) {
    const auto& u = mesh.face(f).vertices;
    const auto& v = mesh.face(g).vertices;
    const auto s = mesh.corners(f);
    const auto t = mesh.corners(g);
    double least = 1e300;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!mesh.face(g).has(u[i]))
            least = std::min(least, geometry::squared_distance_to_triangle(s[i], t[0], t[1], t[2]));
        if (!mesh.face(f).has(v[i]))
            least = std::min(least, geometry::squared_distance_to_triangle(t[i], s[0], s[1], s[2]));
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t i1 = (i + 1) % 3;
            const std::size_t j1 = (j + 1) % 3;
            if (u[i] == v[j] || u[i] == v[j1] || u[i1] == v[j] || u[i1] == v[j1]) continue;
            least = std::min(least, geometry::squared_distance_of_segments(s[i], s[i1], t[j], t[j1]));
        }
    }
    return least;
}

std::vector<ClosePair> close_pairs(const Workbench& bench) {
    const EditMesh& mesh = bench.mesh;
    const double reach = bench.length(bench.options.merge_distance);
    IdVector<FaceId, Pose> poses(mesh.mesh().faces.size());
    std::vector<FacePairs::Item> boxes;
    boxes.reserve(poses.size());
    for (const FaceId f : poses.ids())
        if (mesh.alive(f)) boxes.push_back({f, {}});
    parallel_for(boxes.size(), [&](std::size_t i) {
        const FaceId f = boxes[i].face;
        poses[f] = pose(mesh, f);
        boxes[i].box = mesh.box(f).inflated(0.5 * reach);
    });
    std::vector<ClosePair> pairs =
        FacePairs(boxes).collect<ClosePair>([&](FaceId f, FaceId g, std::vector<ClosePair>& found) {
            if (!face_each_other(mesh.face(f), poses[f], mesh.face(g), poses[g])) return;
            const double squared = squared_gap(mesh, f, g);
            if (squared < reach * reach) found.push_back({squared, f, g});
        });
    std::sort(pairs.begin(), pairs.end(), [](const ClosePair& a, const ClosePair& b) {
        if (a.squared_distance != b.squared_distance) return a.squared_distance < b.squared_distance;
        return a.f != b.f ? a.f < b.f : a.g < b.g;
    });
    return pairs;
}

/// Which vertex of g meets each vertex of f: shared ones themselves, the rest with the least sum of squares.
std::optional<std::array<VertexId, 3>> match(const Workbench& bench, FaceId f, FaceId g) {
    constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    const EditMesh& mesh = bench.mesh;
    const auto& u = mesh.face(f).vertices;
    const auto& v = mesh.face(g).vertices;
    const double farthest = bench.length(0.8);
    std::optional<std::array<VertexId, 3>> best;
    double least = 1e300;
    for (const auto& order : kOrders) {
        double sum = 0.0;
        bool fits = true;
        for (std::size_t i = 0; i < 3 && fits; ++i) {
            const VertexId a = u[i];
            const VertexId b = v[order[i]];
            if (a == b) continue;
            const double squared = squared_norm(mesh.at(a) - mesh.at(b));
            fits = !mesh.face(g).has(a) && !mesh.face(f).has(b) && !mesh.on_wire(a) && !mesh.on_wire(b) &&
                   squared < farthest * farthest;
            sum += squared;
        }
        if (!fits || sum >= least) continue;
        least = sum;
        best = {v[order[0]], v[order[1]], v[order[2]]};
    }
    return best;
}

/// The two triangles become one film, or a hole where the same region lies behind both. A contact is never a point,
/// so that no separation undoes it.
bool merge(Workbench& bench, FaceId f, FaceId g) {
    static const double kSharpest = cot_of_degrees(3.0);
    EditMesh& mesh = bench.mesh;
    const auto partner = match(bench, f, g);
    if (!partner) return false;
    const std::array<VertexId, 3> own = mesh.face(f).vertices;
    const Face one = mesh.face(f);
    const Face two = mesh.face(g);
    const auto s = mesh.corners(f);
    double worst = kSharpest;
    std::vector<FaceId> star;
    for (std::size_t i = 0; i < 3; ++i)
        for (const VertexId v : {own[i], (*partner)[i]})
            for (const FaceId h : mesh.faces_at(v)) star.push_back(h);
    std::sort(star.begin(), star.end());
    star.erase(std::unique(star.begin(), star.end()), star.end());
    for (const FaceId h : star) worst = std::max(worst, 1.001 * sharpest_cot(mesh.corners(h)));

    const StarVolumes before = star_volumes(mesh, star, s[0]);
    mesh.begin();
    bool fits = true;
    for (std::size_t i = 0; i < 3 && fits; ++i)
        if (own[i] != (*partner)[i])
            fits = identify(mesh, own[i], (*partner)[i], 0.5 * (mesh.at(own[i]) + mesh.at((*partner)[i])));
    if (fits)
        for (const VertexId v : own)
            if (!mesh.faces_at(v).empty() && !mesh.on_wire(v))
                restore_volumes(mesh, v, before, s[0], bench.length(0.1));
    if (!fits || !acceptable(mesh, worst)) {
        mesh.rollback();
        return false;
    }
    mesh.commit();
    for (std::size_t i = 0; i < 3; ++i)
        if (own[i] != (*partner)[i]) bench.resample(own[i], {own[i], (*partner)[i]}, {0.5, 0.5});
    // The regions that now meet: those that were behind the region in between.
    const auto other = [](const Face& face, const Face& rival) {
        return face.back == rival.back || face.back == rival.front ? face.front : face.back;
    };
    bench.events.push_back(
        {TopologyEvent::Kind::kMerge, (1.0 / 3.0) * (s[0] + s[1] + s[2]), other(one, two), other(two, one)});
    ++bench.report.merges;
    bench.topology_changed = true;
    return true;
}

}  // namespace

void merge_close_faces(Workbench& bench) {
    EditMesh& mesh = bench.mesh;
    for (const ClosePair& pair : close_pairs(bench)) {
        // An earlier merge may have changed or taken either.
        if (!mesh.alive(pair.f) || !mesh.alive(pair.g)) continue;
        if (face_each_other(mesh.face(pair.f), pose(mesh, pair.f), mesh.face(pair.g), pose(mesh, pair.g)))
            merge(bench, pair.f, pair.g);
    }
}

}  // namespace lamella::mesh::detail
