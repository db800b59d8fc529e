#include "lamella/mesh/check.h"

#include "lamella/core/error.h"
#include "lamella/geometry/triangle_intersection.h"
#include "lamella/mesh/area.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/volume.h"
#include "lamella/spatial/bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace lamella::mesh {
namespace {

using spatial::Bounds;

bool finite(const Vec3& x) { return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]); }

class Audit {
public:
    Audit(const FoamMesh& mesh, const CheckOptions& options) : mesh_(mesh), options_(options) {}

    std::vector<std::string> run() {
        columns();
        if (found_.empty()) elements();
        if (found_.empty()) edges();
        if (found_.empty()) regions();
        if (found_.empty() && options_.intersections) intersections();
        return std::move(found_);
    }

    std::size_t count_intersections() {
        intersections();
        return found_.size();
    }

private:
    bool full() const { return found_.size() >= options_.longest_list; }
    template <class... Args>
    void report(fmt::format_string<Args...> text, Args&&... args) {
        if (!full()) found_.push_back(fmt::format(text, std::forward<Args>(args)...));
    }

    template <class Id>
    std::string called(Id id) const {
        return options_.names.of(id);
    }

    void columns() {
        if (mesh_.on_wire.size() != mesh_.position.size())
            report("{} positions but {} wire marks", mesh_.position.size(), mesh_.on_wire.size());
        if (!mesh_.images.empty() && mesh_.images.size() != mesh_.faces.size())
            report("{} faces but images of {}", mesh_.faces.size(), mesh_.images.size());
        if (mesh_.regions.empty()) report("there is no region, not even the outside");
        const double cell = dot(mesh_.period[0], cross(mesh_.period[1], mesh_.period[2]));
        if (mesh_.periodic() && !(std::abs(cell) > 0.0)) report("the periods span no volume");
    }

    void elements() {
        IdVector<VertexId, std::uint8_t> used(mesh_.position.size(), 0);
        for (const VertexId v : mesh_.position.ids())
            if (!finite(mesh_.position[v])) report("vertex {} is not at a finite place", called(v));
        std::map<std::pair<std::array<VertexId, 3>, std::array<int, 6>>, FaceId> known;
        for (const FaceId f : mesh_.faces.ids()) {
            const Face& face = mesh_.faces[f];
            bool in_range = true;
            for (const VertexId v : face.vertices)
                if (index(v) >= mesh_.position.size()) {
                    report("face {} has vertex {} of {}", called(f), index(v), mesh_.position.size());
                    in_range = false;
                }
            for (const RegionId r : {face.back, face.front})
                if (index(r) >= mesh_.regions.size()) {
                    report("face {} has region {} of {}", called(f), index(r), mesh_.regions.size());
                    in_range = false;
                } else if (mesh_.regions[r].kind == RegionKind::kGone) {
                    report("face {} has region {}, which is gone", called(f), index(r));
                }
            if (!in_range) continue;
            for (const VertexId v : face.vertices) used[v] = 1;
            if (face.back == face.front && !mesh_.periodic())
                report("face {} has region {} on both sides", called(f), index(face.back));
            shape(f, known);
        }
        for (const VertexId v : used.ids())
            if (used[v] == 0) report("vertex {} belongs to no face", called(v));
    }

    void shape(FaceId f, std::map<std::pair<std::array<VertexId, 3>, std::array<int, 6>>, FaceId>& known) {
        const std::array<Vec3, 3> x{mesh_.corner(f, 0), mesh_.corner(f, 1), mesh_.corner(f, 2)};
        if (!finite(x[0]) || !finite(x[1]) || !finite(x[2])) return;
        const auto& v = mesh_.faces[f].vertices;
        if (!mesh_.periodic() && (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])) {
            report("face {} has a vertex twice", called(f));
            return;
        }
        if (norm(cross(x[1] - x[0], x[2] - x[0])) == 0.0) report("face {} has no area", called(f));
        // The same vertices in the same images, whatever the order and whichever image comes first.
        std::array<std::size_t, 3> order{0, 1, 2};
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            if (v[a] != v[b]) return v[a] < v[b];
            return mesh_.periodic() && mesh_.images[f][a] < mesh_.images[f][b];
        });
        std::array<int, 6> images{};
        if (mesh_.periodic())
            for (std::size_t k = 0; k < 6; ++k)
                images[k] = mesh_.images[f][order[1 + k / 3]][k % 3] - mesh_.images[f][order[0]][k % 3];
        const auto [it, fresh] = known.try_emplace({{v[order[0]], v[order[1]], v[order[2]]}, images}, f);
        if (!fresh) report("faces {} and {} have the same vertices", called(it->second), called(f));
    }

    void edges() {
        const EdgeFaces edges = edge_faces(mesh_);
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const auto [a, b, shift] = edges.edge[e];
            if (mesh_.on_wire[a] != 0 && mesh_.on_wire[b] != 0) continue;
            std::map<RegionId, int> sum;  // what enters a region's surface along the edge must leave it
            for (const EdgeUse& use : edges.of(e)) {
                const Face& face = mesh_.faces[use.face];
                sum[face.back] += use.forward ? 1 : -1;
                sum[face.front] -= use.forward ? 1 : -1;
            }
            for (const auto& [region, count] : sum)
                if (count != 0) {
                    report("edge {}-{} does not close region {}: a film ends there, but no wire holds it", called(a),
                           called(b), index(region));
                    break;
                }
            if (edges.of(e).size() == 1) report("edge {}-{} has one face only", called(a), called(b));
        }
    }

    void regions() {
        const auto volumes = region_volumes(mesh_);
        IdVector<RegionId, std::size_t> sides(mesh_.regions.size(), 0);
        for (const Face& face : mesh_.faces) {
            ++sides[face.back];
            ++sides[face.front];
        }
        for (const RegionId r : mesh_.regions.ids()) {
            if (mesh_.regions[r].kind != RegionKind::kClosed) continue;
            if (sides[r] == 0) report("region {} is closed but has no face", index(r));
            else if (!mesh_.periodic() && !(volumes[r] > 0.0))
                report("region {} has volume {:.3g}: its faces are turned inside out", index(r), volumes[r]);
            if (!(mesh_.regions[r].target_volume > 0.0) || !std::isfinite(mesh_.regions[r].target_volume))
                report("region {} has the target volume {}", index(r), mesh_.regions[r].target_volume);
        }
    }

    std::array<Vec3, 3> corners(FaceId f, const Vec3& shift) const {
        return {mesh_.corner(f, 0) + shift, mesh_.corner(f, 1) + shift, mesh_.corner(f, 2) + shift};
    }
    static Bounds bounds(const std::array<Vec3, 3>& x) {
        Bounds b{x[0], x[0]};
        b.enclose({x[1], x[1]});
        b.enclose({x[2], x[2]});
        return b;
    }

    void intersections() {
        std::vector<Bounds> boxes;
        for (const FaceId f : mesh_.faces.ids()) boxes.push_back(bounds(corners(f, {})));
        const spatial::BoxTree tree(boxes);
        const int reach = mesh_.periodic() ? 2 : 0;
        for (const FaceId f : mesh_.faces.ids())
            for (int i = -reach; i <= reach; ++i)
                for (int j = -reach; j <= reach; ++j)
                    for (int k = -reach; k <= reach; ++k) {
                        const Vec3 shift = i * mesh_.period[0] + j * mesh_.period[1] + k * mesh_.period[2];
                        const auto s = corners(f, shift);
                        tree.query(bounds(s), [&](std::size_t g) {
                            if (index(f) < g) test(f, s, static_cast<FaceId>(g));
                            return !full();
                        });
                        if (full()) return;
                    }
    }

    /// Corners count as shared when they are the same point, so that images need no bookkeeping.
    void test(FaceId f, const std::array<Vec3, 3>& at, FaceId g) {
        const auto other = corners(g, {});
        std::array<Vec3, 3> s, t;
        std::array<bool, 3> f_shared{}, g_shared{};
        std::size_t shared = 0;
        const auto same = [&](std::size_t a, std::size_t b) {
            if (mesh_.faces[f].vertices[a] != mesh_.faces[g].vertices[b]) return false;
            return !mesh_.periodic() || norm(at[a] - other[b]) < 1e-9 * norm(mesh_.period[0]);
        };
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b)
                if (same(a, b)) {
                    s[shared] = t[shared] = at[a];
                    ++shared;
                    f_shared[a] = g_shared[b] = true;
                }
        if (shared == 3) return;
        std::size_t m = shared, n = shared;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!f_shared[k]) s[m++] = at[k];
            if (!g_shared[k]) t[n++] = other[k];
        }
        const bool meet = shared == 0 ? geometry::triangles_meet(s, t)
                                      : geometry::triangles_meet_beyond_shared(s, t, static_cast<int>(shared));
        if (!meet) return;
        const Vec3 middle = (at[0] + at[1] + at[2]) / 3.0;
        report("faces {} and {} cut each other near ({:.6g}, {:.6g}, {:.6g})", called(f), called(g), middle[0], middle[1],
               middle[2]);
    }

    const FoamMesh& mesh_;
    CheckOptions options_;
    std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> faults(const FoamMesh& mesh, const CheckOptions& options) { return Audit(mesh, options).run(); }

std::size_t intersecting_pairs(const FoamMesh& mesh, std::size_t most) {
    return Audit(mesh, {.longest_list = most}).count_intersections();
}

void require_sound(const FoamMesh& mesh, const std::string& name, const CheckOptions& options) {
    const std::vector<std::string> found = faults(mesh, options);
    if (found.empty()) return;
    throw InputError(fmt::format("{}: {}{}", name, found[0],
                                 found.size() > 1 ? fmt::format(" (and {} faults more)", found.size() - 1) : ""));
}

}  // namespace lamella::mesh
