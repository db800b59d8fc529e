#include "lamella/mesh/detail/face_shape.h"
#include "lamella/mesh/detail/sectors.h"
#include "lamella/mesh/detail/workbench.h"

#include <algorithm>

namespace lamella::mesh::detail {
namespace {

/// One way to part a vertex: these faces take the copy, which goes along `direction`.
struct Parting {
    std::uint64_t moved[2] = {0, 0};  // bit i: faces_at(v)[i] takes the copy
    Vec3 direction;
    double gain = 0.0;  // area that it saves at a small distance
    bool pinch = false;
    RegionId a = kOutside, b = kOutside;

    bool moves(std::size_t i) const { return (moved[i / 64] >> (i % 64)) & 1U; }
    void move(std::size_t i) { moved[i / 64] |= std::uint64_t{1} << (i % 64); }
};

/// A face that opens between the two copies along edge v - w, labelled for (copy, v, w).
struct Gap {
    VertexId w;
    RegionId back, front;
};

/// What the moved faces leave open along each of v's edges: S_w = sum of s (e[back] - e[front]) over the moved faces
/// at w. Zero: nothing opens. e[X] - e[Y]: a face (copy, v, w) between X and Y closes it. Anything else: impossible.
std::optional<SmallVector<Gap, 12>> gaps(const EditMesh& mesh, VertexId v, const Parting& parting) {
    SmallVector<Gap, 12> result;
    const FaceList& faces = mesh.faces_at(v);
    SmallVector<VertexId, 12> done;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (!parting.moves(i)) continue;
        for (const VertexId w : mesh.face(faces[i]).vertices) {
            if (w == v || done.contains(w)) continue;
            done.push_back(w);
            SmallVector<RegionId, 6> plus, minus;
            const auto add = [](auto& to, auto& from, RegionId r) {
                for (std::size_t k = 0; k < from.size(); ++k)
                    if (from[k] == r) return from.erase(k);
                to.push_back(r);
            };
            for (std::size_t j = 0; j < faces.size(); ++j) {
                const Face& face = mesh.face(faces[j]);
                if (!parting.moves(j) || !face.has(w)) continue;
                add(plus, minus, behind_of(face, v, w));
                add(minus, plus, ahead_of(face, v, w));
            }
            if (plus.empty()) continue;
            if (plus.size() > 1) return std::nullopt;
            result.push_back({w, plus[0], minus[0]});
        }
    }
    return result;
}

/// Area of the faces at v and of the gaps when the copy is at v + s d and v at v - s d.
double area_apart(
    const EditMesh& mesh, VertexId v, const Parting& parting, const SmallVector<Gap, 12>& gaps, double s) {
    const Vec3 copy = mesh.at(v) + s * parting.direction;
    const Vec3 rest = mesh.at(v) - s * parting.direction;
    double sum = 0.0;
    const FaceList& faces = mesh.faces_at(v);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto& u = mesh.face(faces[i]).vertices;
        const std::size_t k = u[0] == v ? 0 : u[1] == v ? 1 : 2;
        sum += area(parting.moves(i) ? copy : rest, mesh.at(u[(k + 1) % 3]), mesh.at(u[(k + 2) % 3]));
    }
    for (const Gap& gap : gaps) sum += area(copy, rest, mesh.at(gap.w));
    return sum;
}

/// Centroid of the outer edges of those faces at v that `chosen` names.
template <class Chosen>
Vec3 centroid(const EditMesh& mesh, VertexId v, Chosen&& chosen) {
    const FaceList& faces = mesh.faces_at(v);
    Vec3 sum;
    double count = 0.0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (!chosen(i)) continue;
        for (const VertexId w : mesh.face(faces[i]).vertices)
            if (w != v) {
                sum += mesh.at(w) - mesh.at(v);
                count += 1.0;
            }
    }
    return count > 0.0 ? (1.0 / count) * sum : sum;
}

bool point_apart(Parting& parting, const Vec3& towards, const Vec3& away) {
    const Vec3 d = towards - away;
    const double length = norm(d);
    if (length == 0.0) return false;
    parting.direction = (1.0 / length) * d;
    return true;
}

/// Parts of a pinched vertex: each group of faces that hang together may leave.
void pinches(const EditMesh& mesh, VertexId v, const Sectors& sectors, std::vector<Parting>& partings) {
    for (std::uint8_t c = 0; c < sectors.components; ++c) {
        Parting parting;
        parting.pinch = true;
        parting.gain = 1.0;  // always worth it
        for (std::size_t i = 0; i < sectors.faces.size(); ++i)
            if (sectors.faces[i].component == c) parting.move(i);
        const Vec3 towards = centroid(mesh, v, [&](std::size_t i) { return parting.moves(i); });
        const Vec3 away = centroid(mesh, v, [&](std::size_t i) { return !parting.moves(i); });
        if (point_apart(parting, towards, away)) partings.push_back(parting);
    }
}

bool is_held(const Workbench& bench, const Vec3& place, RegionId a, RegionId b) {
    const double near = bench.length(2.0);
    return std::any_of(bench.held.begin(), bench.held.end(), [&](const Crossing& crossing) {
        const bool same = (crossing.a == a && crossing.b == b) || (crossing.a == b && crossing.b == a);
        return same && squared_norm(crossing.position - place) < near * near;
    });
}

/// Two sectors without a common face: the faces of one of them may leave the other.
void crossings(const Workbench& bench, VertexId v, const Sectors& sectors, std::vector<Parting>& partings) {
    const EditMesh& mesh = bench.mesh;
    const auto touches = [&](std::size_t i, std::size_t sector) {
        return sectors.faces[i].back == sector || sectors.faces[i].front == sector;
    };
    const double trial = bench.length(0.05);
    for (std::size_t p = 0; p < sectors.count(); ++p)
        for (std::size_t q = 0; q < sectors.count(); ++q) {
            if (p == q || ((sectors.neighbors[p] >> q) & 1U)) continue;
            Parting parting;
            parting.a = sectors.labels[p];
            parting.b = sectors.labels[q];
            if (is_held(bench, mesh.at(v), parting.a, parting.b)) continue;
            for (std::size_t i = 0; i < sectors.faces.size(); ++i)
                if (touches(i, p)) parting.move(i);
            const Vec3 towards = centroid(mesh, v, [&](std::size_t i) { return touches(i, p); });
            const Vec3 away = centroid(mesh, v, [&](std::size_t i) { return touches(i, q); });
            if (!point_apart(parting, towards, away)) continue;
            const auto open = gaps(mesh, v, parting);
            if (!open) continue;
            parting.gain = area_apart(mesh, v, parting, {}, 0.0) - area_apart(mesh, v, parting, *open, trial);
            const double allowed_cost = bench.options.separation_cost * bench.length(1.0) * bench.length(1.0);
            if (parting.gain > -allowed_cost) partings.push_back(parting);
        }
}

VertexId pull(EditMesh& mesh, VertexId v, const Parting& parting, const SmallVector<Gap, 12>& gaps, double s) {
    const Vec3 from = mesh.at(v);
    const VertexId copy = mesh.add_vertex(from + s * parting.direction, false);
    const FaceList faces = mesh.faces_at(v);
    mesh.move_vertex(v, from - s * parting.direction);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (!parting.moves(i)) continue;
        Face face = mesh.face(faces[i]);
        for (VertexId& u : face.vertices)
            if (u == v) u = copy;
        mesh.set_face(faces[i], face);
    }
    for (const Gap& gap : gaps) mesh.add_face({{copy, v, gap.w}, gap.back, gap.front});
    return copy;
}

}  // namespace

std::optional<Separation> separate_vertex(
    const Workbench& bench, VertexId v, const StarVolumes& before, const Vec3& origin, double sharpest) {
    EditMesh& mesh = bench.mesh;
    const auto sectors = sectors_at(mesh, v);
    if (!sectors) return std::nullopt;
    std::vector<Parting> partings;
    if (sectors->components > 1)
        pinches(mesh, v, *sectors, partings);
    else
        crossings(bench, v, *sectors, partings);
    std::stable_sort(partings.begin(), partings.end(),
                     [](const Parting& a, const Parting& b) { return a.gain > b.gain; });
    const Vec3 place = mesh.at(v);
    for (const Parting& parting : partings) {
        const auto open = gaps(mesh, v, parting);
        if (!open) continue;
        for (const double part : {1.0, 0.5, 0.25}) {
            const double s = part * bench.length(bench.options.separation);
            const std::size_t mark = mesh.mark();
            const VertexId copy = pull(mesh, v, parting, *open, s);
            restore_volumes(mesh, v, before, origin, 0.5 * s);
            if (acceptable(mesh, sharpest)) {
                const auto kind = parting.pinch ? TopologyEvent::Kind::kPinch : TopologyEvent::Kind::kT1;
                return Separation{v, copy, {kind, place, parting.a, parting.b}};
            }
            mesh.rollback_to(mark);
        }
    }
    return std::nullopt;
}

void separate_vertices(Workbench& bench) {
    static const double kSharpest = cot_of_degrees(2.0);
    constexpr int kMostPasses = 5;
    EditMesh& mesh = bench.mesh;
    std::vector<VertexId> irregular;
    for (const VertexId v : mesh.mesh().position.ids()) {
        if (!mesh.suspect(v) || mesh.faces_at(v).empty() || mesh.on_wire(v)) continue;
        if (is_regular(mesh, v))
            mesh.clear_suspicion(v);
        else
            irregular.push_back(v);
    }
    for (int pass = 0; pass < kMostPasses && !irregular.empty(); ++pass) {
        std::vector<VertexId> left;
        bool any = false;
        for (const VertexId v : irregular) {
            if (mesh.faces_at(v).empty() || is_regular(mesh, v)) continue;
            mesh.begin();
            const FaceList star = mesh.faces_at(v);
            double worst = kSharpest;
            for (const FaceId f : star) worst = std::max(worst, 1.001 * sharpest_cot(mesh.corners(f)));
            const Vec3 origin = mesh.at(v);
            const auto parted = separate_vertex(
                bench, v, star_volumes(mesh, std::vector<FaceId>(star.begin(), star.end()), origin), origin, worst);
            if (!parted) {
                mesh.rollback();
                left.push_back(v);
                continue;
            }
            mesh.commit();
            bench.resample(v, {v}, {1.0});
            bench.resample(parted->copy, {v}, {1.0});
            bench.events.push_back(parted->event);
            ++bench.report.separations;
            bench.topology_changed = any = true;
            left.push_back(v);
            left.push_back(parted->copy);
            for (const VertexId end : {v, parted->copy})
                for (const FaceId f : mesh.faces_at(end))
                    for (const VertexId w : mesh.face(f).vertices)
                        if (!mesh.on_wire(w) && !is_regular(mesh, w)) left.push_back(w);
        }
        std::sort(left.begin(), left.end());
        left.erase(std::unique(left.begin(), left.end()), left.end());
        irregular = std::move(left);
        if (!any) break;
    }
    for (const VertexId v : irregular)
        if (!mesh.faces_at(v).empty() && !is_regular(mesh, v)) ++bench.report.stuck;
}

}  // namespace lamella::mesh::detail
