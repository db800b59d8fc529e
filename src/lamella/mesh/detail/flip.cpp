#include "lamella/mesh/detail/face_shape.h"
#include "lamella/mesh/detail/workbench.h"

#include <algorithm>
#include <numbers>

namespace lamella::mesh::detail {
namespace {

struct Diamond {
    FaceId f, g;
    VertexId v, w;  // the edge, f runs from v to w
    VertexId c, d;  // the corners of f and g opposite it
};

VertexId opposite(const Face& face, VertexId v, VertexId w) {
    for (const VertexId u : face.vertices)
        if (u != v && u != w) return u;
    return kNoVertex;
}

/// cot(alpha + beta) from the two cotangents.
double cot_of_sum(double a, double b) { return (a * b - 1.0) / (a + b); }

/// The two angles opposite the edge add up to more than pi and the margin: the edge is far from Delaunay.
bool wants_flip(const EditMesh& mesh, const Diamond& q, double cot_margin) {
    const double a = cot_at(mesh.at(q.c), mesh.at(q.v), mesh.at(q.w));
    const double b = cot_at(mesh.at(q.d), mesh.at(q.v), mesh.at(q.w));
    if (a + b >= 0.0) return false;
    return cot_of_sum(a, b) < cot_margin;
}

bool flip(Workbench& bench, const Diamond& q) {
    EditMesh& mesh = bench.mesh;
    const Face f = mesh.face(q.f);
    if (!mesh.faces_on(q.c, q.d).empty()) return false;
    const Vec3 old_f = area_vector(mesh.corners(q.f));
    const Face other = mesh.face(q.g);
    // g seen with f's orientation: it must run w -> v when its labels are f's.
    const bool alike = other.back == f.back && other.front == f.front;
    const Vec3 old_g = (alike ? 1.0 : -1.0) * area_vector(mesh.corners(q.g));
    if (dot(old_f, old_g) < 0.8 * norm(old_f) * norm(old_g)) return false;
    const double worst = std::max(sharpest_cot(mesh.corners(q.f)), sharpest_cot(mesh.corners(q.g)));
    mesh.begin();
    mesh.set_face(q.f, {{q.c, q.v, q.d}, f.back, f.front});
    mesh.set_face(q.g, {{q.d, q.w, q.c}, f.back, f.front});
    const Vec3 sum = old_f + old_g;
    const auto turned = [&](FaceId face) {  // by more than 53 degrees
        const Vec3 now = area_vector(mesh.corners(face));
        return dot(now, sum) < 0.6 * norm(now) * norm(sum);
    };
    if (turned(q.f) || turned(q.g) || !acceptable(mesh, worst)) {
        mesh.rollback();
        return false;
    }
    mesh.commit();
    ++bench.report.flips;
    return true;
}

}  // namespace

void flip_edges(Workbench& bench) {
    EditMesh& mesh = bench.mesh;
    const double cot_margin = cot_of_degrees((bench.options.flip_angle - 1.0) * 180.0);
    for (const FaceId f : mesh.mesh().faces.ids()) {
        for (std::size_t k = 0; k < 3 && mesh.alive(f); ++k) {
            const auto& u = mesh.face(f).vertices;
            Diamond q{f, kNoFace, u[k], u[(k + 1) % 3], u[(k + 2) % 3], kNoVertex};
            // Cheap first: an edge is far from Delaunay only if it is opposite an obtuse angle.
            const double cot_c = cot_at(mesh.at(q.c), mesh.at(q.v), mesh.at(q.w));
            if (cot_c >= 0.0 || (mesh.on_wire(q.v) && mesh.on_wire(q.w))) continue;
            const auto faces = mesh.faces_on(q.v, q.w);
            if (faces.size() != 2) continue;
            q.g = faces[0] == f ? faces[1] : faces[0];
            q.d = opposite(mesh.face(q.g), q.v, q.w);
            if (wants_flip(mesh, q, cot_margin) && flip(bench, q)) break;
        }
    }
}

}  // namespace lamella::mesh::detail
