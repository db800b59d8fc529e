#include "lamella/geometry/triangle_intersection.h"
#include "lamella/mesh/detail/face_shape.h"
#include "lamella/mesh/detail/sectors.h"
#include "lamella/mesh/detail/workbench.h"

#include <algorithm>

namespace lamella::mesh::detail {
namespace {

/// Faces that share an edge and are folded onto each other by less than 1.1 degrees.
bool folded(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t) {
    const Vec3 axis = s[1] - s[0];
    const Vec3 m = cross(axis, s[2] - s[0]);
    const Vec3 n = cross(axis, t[2] - t[0]);
    return dot(m, n) > 0.0 && squared_norm(cross(m, n)) < 3.7e-4 * squared_norm(m) * squared_norm(n);
}

/// Whether two different faces meet elsewhere than in what they share.
bool faces_meet(const EditMesh& mesh, FaceId f, FaceId g) {
    const auto& u = mesh.face(f).vertices;
    const auto& v = mesh.face(g).vertices;
    std::array<Vec3, 3> s, t;
    int shared = 0;
    std::array<bool, 3> used{};
    SmallVector<VertexId, 3> rest;
    for (const VertexId a : u) {
        const auto* same = std::find(v.begin(), v.end(), a);
        if (same == v.end()) {
            rest.push_back(a);
            continue;
        }
        used[static_cast<std::size_t>(same - v.begin())] = true;
        s[static_cast<std::size_t>(shared)] = t[static_cast<std::size_t>(shared)] = mesh.at(a);
        ++shared;
    }
    if (shared == 3) return true;
    std::size_t at = static_cast<std::size_t>(shared);
    for (const VertexId a : rest) s[at++] = mesh.at(a);
    at = static_cast<std::size_t>(shared);
    for (std::size_t k = 0; k < 3; ++k)
        if (!used[k]) t[at++] = mesh.at(v[k]);
    if (shared == 0) return geometry::triangles_meet(s, t);
    if (shared == 2) return folded(s, t);
    return geometry::triangles_meet_beyond_shared(s, t, 1);
}

bool labels_and_shapes(const EditMesh& mesh, double sharpest) {
    for (const FaceId f : mesh.touched()) {
        if (!mesh.alive(f)) continue;
        if (mesh.face(f).back == mesh.face(f).front) return false;
        if (sharpest_cot(mesh.corners(f)) > sharpest) return false;
    }
    return !mesh.starves_a_region();
}

/// Only edges with three or more faces: with two, the labels fit whatever the geometry.
bool label_cycles(const EditMesh& mesh) {
    for (const FaceId f : mesh.touched()) {
        if (!mesh.alive(f)) continue;
        const auto& u = mesh.face(f).vertices;
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId v = u[k];
            const VertexId w = u[(k + 1) % 3];
            const auto faces = mesh.faces_on(v, w);
            if (faces.size() == 2 || (mesh.on_wire(v) && mesh.on_wire(w))) continue;
            if (!label_cycle_holds(mesh, v, w)) return false;
        }
    }
    return true;
}

/// One search of the grid for all touched faces: they lie close together.
bool intersections(const EditMesh& mesh) {
    struct Near {
        FaceId face;
        Box box;
    };
    SmallVector<Near, 24> changed;
    for (const FaceId f : mesh.touched())
        if (mesh.alive(f)) changed.push_back({f, mesh.box(f)});
    if (changed.empty()) return false;
    Box all = changed[0].box;
    for (const Near& a : changed) {
        all.include(a.box.low);
        all.include(a.box.high);
    }
    SmallVector<Near, 64> around;
    mesh.grid().query(all, [&](FaceId g) {
        if (!mesh.is_touched(g)) around.push_back({g, mesh.grid().box(g)});
    });
    for (std::size_t i = 0; i < changed.size(); ++i) {
        const Near& a = changed[i];
        for (std::size_t j = 0; j < i; ++j)
            if (a.box.overlaps(changed[j].box) && faces_meet(mesh, a.face, changed[j].face)) return true;
        for (const Near& b : around)
            if (a.box.overlaps(b.box) && faces_meet(mesh, a.face, b.face)) return true;
    }
    return false;
}

}  // namespace

bool acceptable(const EditMesh& mesh, double sharpest) {
    return labels_and_shapes(mesh, sharpest) && label_cycles(mesh) && !intersections(mesh);
}

bool cancel_flaps(EditMesh& mesh, VertexId v) {
    for (bool again = true; again;) {
        again = false;
        const FaceList faces = mesh.faces_at(v);
        for (std::size_t i = 0; i < faces.size() && !again; ++i)
            for (std::size_t j = i + 1; j < faces.size() && !again; ++j) {
                Face one = mesh.face(faces[i]);
                const Face two = mesh.face(faces[j]);
                if (!(one.has(two.vertices[0]) && one.has(two.vertices[1]) && one.has(two.vertices[2]))) continue;
                const bool alike = direction(one, two.vertices[0], two.vertices[1]) > 0;
                const RegionId back = alike ? two.back : two.front;
                const RegionId front = alike ? two.front : two.back;
                if (one.front == back)
                    one.front = front;
                else if (one.back == front)
                    one.back = back;
                else
                    return false;
                if (one.back == one.front)
                    mesh.kill_face(faces[i]);
                else
                    mesh.set_face(faces[i], one);
                mesh.kill_face(faces[j]);
                again = true;
            }
    }
    return true;
}

bool identify(EditMesh& mesh, VertexId kept, VertexId gone, const Vec3& place) {
    const FaceList faces = mesh.faces_at(gone);
    for (const FaceId f : faces) {
        Face face = mesh.face(f);
        if (face.has(kept)) {
            mesh.kill_face(f);
            continue;
        }
        for (VertexId& v : face.vertices)
            if (v == gone) v = kept;
        mesh.set_face(f, face);
    }
    mesh.move_vertex(kept, place);
    return cancel_flaps(mesh, kept);
}

void StarVolumes::add(RegionId r, double volume) {
    for (std::size_t i = 0; i < regions.size(); ++i)
        if (regions[i] == r) {
            volumes[i] += volume;
            return;
        }
    regions.push_back(r);
    volumes.push_back(volume);
}

double StarVolumes::of(RegionId r) const {
    for (std::size_t i = 0; i < regions.size(); ++i)
        if (regions[i] == r) return volumes[i];
    return 0.0;
}

StarVolumes star_volumes(const EditMesh& mesh, const std::vector<FaceId>& faces, const Vec3& origin) {
    StarVolumes sum;
    for (const FaceId f : faces) {
        if (!mesh.alive(f)) continue;
        const auto [a, b, c] = mesh.corners(f);
        const double volume = dot(a - origin, cross(b - origin, c - origin)) / 6.0;
        sum.add(mesh.face(f).back, volume);
        sum.add(mesh.face(f).front, -volume);
    }
    return sum;
}

// The volume of a region is linear in v: dV = g_r . dx with g_r = sum of (b - a) x (c - a) / 6 over its sides at v. The
// shortest dx that gives every region its volume back solves (sum_r g_r g_r^T) dx = sum_r g_r dV_r, in the span of
// the g_r.
void restore_volumes(EditMesh& mesh, VertexId v, const StarVolumes& before, const Vec3& origin, double farthest) {
    const StarVolumes after = star_volumes(mesh, mesh.touched(), origin);
    SmallVector<RegionId, 8> regions;
    SmallVector<Vec3, 8> gradients;
    for (const FaceId f : mesh.faces_at(v)) {
        const Face& face = mesh.face(f);
        const std::size_t k = face.vertices[0] == v ? 0 : face.vertices[1] == v ? 1 : 2;
        const Vec3 b = mesh.at(face.vertices[(k + 1) % 3]);
        const Vec3 c = mesh.at(face.vertices[(k + 2) % 3]);
        const Vec3 gradient = (1.0 / 6.0) * cross(b - origin, c - origin);
        for (const auto& [r, sign] : {std::pair{face.back, 1.0}, std::pair{face.front, -1.0}}) {
            std::size_t i = 0;
            while (i < regions.size() && regions[i] != r) ++i;
            if (i == regions.size()) {
                regions.push_back(r);
                gradients.push_back({});
            }
            gradients[i] += sign * gradient;
        }
    }
    // Conjugate gradients on the normal equations: at most three steps, from zero, so dx stays in the span.
    Vec3 rhs;
    double scale = 0.0;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        rhs += (before.of(regions[i]) - after.of(regions[i])) * gradients[i];
        scale += squared_norm(gradients[i]);
    }
    const auto apply = [&](const Vec3& x) {
        Vec3 y;
        for (const Vec3& g : gradients) y += dot(g, x) * g;
        return y;
    };
    Vec3 dx, residual = rhs, p = rhs;
    double squared = squared_norm(residual);
    for (int step = 0; step < 3 && squared > 1e-24 * squared_norm(rhs) && squared > 0.0; ++step) {
        const Vec3 image = apply(p);
        const double curvature = dot(p, image);
        if (curvature < 1e-3 * scale * squared_norm(p)) break;  // a direction that hardly changes any volume
        const double alpha = squared / curvature;
        dx += alpha * p;
        residual -= alpha * image;
        const double next = squared_norm(residual);
        p = residual + (next / squared) * p;
        squared = next;
    }
    if (squared_norm(dx) > 0.0 && norm(dx) <= farthest) mesh.move_vertex(v, mesh.at(v) + dx);
}

}  // namespace lamella::mesh::detail
