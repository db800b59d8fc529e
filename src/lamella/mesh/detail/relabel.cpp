#include "lamella/mesh/detail/sectors.h"
#include "lamella/mesh/detail/workbench.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lamella::mesh::detail {
namespace {

/// Disjoint sets of the sides of all faces: 2 f is the back of face f, 2 f + 1 its front. The smallest member is the
/// root, whatever the order of the calls.
class SideSets {
public:
    explicit SideSets(std::size_t faces) : parent_(2 * faces) { std::iota(parent_.begin(), parent_.end(), 0U); }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(std::uint32_t i, std::uint32_t j) {
        const std::uint32_t a = root(i);
        const std::uint32_t b = root(j);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

std::uint32_t side(FaceId f, bool front) { return 2 * static_cast<std::uint32_t>(f) + (front ? 1U : 0U); }

/// A connected part of a region's boundary.
struct Piece {
    std::uint32_t root;
    RegionId region;
    double volume = 0.0;  // enclosed; negative for a cavity, or for the outside seen from within
    std::vector<FaceId> faces;
    bool open = false;  // reaches a wire where the film ends
};

std::vector<Piece> pieces_of(const EditMesh& mesh) {
    const auto& faces = mesh.mesh().faces;
    SideSets sets(faces.size());
    std::vector<std::uint8_t> at_rim(faces.size(), 0);
    for (const FaceId f : faces.ids()) {
        if (!mesh.alive(f)) continue;
        const auto& u = mesh.face(f).vertices;
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId v = u[k];
            const VertexId w = u[(k + 1) % 3];
            auto around = mesh.faces_on(v, w);
            if (around[0] != f) continue;  // once per edge
            if (mesh.on_wire(v) && mesh.on_wire(w)) {
                for (const FaceId g : around) at_rim[index(g)] = 1;
                continue;
            }
            sort_around(mesh, v, w, around);
            for (std::size_t i = 0; i < around.size(); ++i) {
                const FaceId g = around[i];
                const FaceId next = around[i + 1 < around.size() ? i + 1 : 0];
                sets.unite(side(g, direction(mesh.face(g), v, w) > 0),
                           side(next, direction(mesh.face(next), v, w) < 0));
            }
        }
    }
    std::vector<Piece> pieces;
    std::vector<std::uint32_t> piece_of(2 * faces.size(), 0xffffffffU);
    for (const FaceId f : faces.ids()) {
        if (!mesh.alive(f)) continue;
        const auto [a, b, c] = mesh.corners(f);
        const double volume = dot(a, cross(b, c)) / 6.0;
        for (const bool front : {false, true}) {
            const std::uint32_t root = sets.root(side(f, front));
            if (piece_of[root] == 0xffffffffU) {
                piece_of[root] = static_cast<std::uint32_t>(pieces.size());
                pieces.push_back({root, front ? mesh.face(f).front : mesh.face(f).back, 0.0, {}, false});
            }
            Piece& piece = pieces[piece_of[root]];
            piece.volume += front ? -volume : volume;
            piece.faces.push_back(f);
            piece.open = piece.open || at_rim[index(f)] != 0;
        }
    }
    return pieces;
}

/// How often the piece winds around a point: 1 inside, 0 outside. Solid angles by [VanOosterom83].
double winding(const EditMesh& mesh, const Piece& piece, const Vec3& point) {
    double sum = 0.0;
    for (const FaceId f : piece.faces) {
        const auto corners = mesh.corners(f);
        const Vec3 a = corners[0] - point;
        const Vec3 b = corners[1] - point;
        const Vec3 c = corners[2] - point;
        const double la = norm(a), lb = norm(b), lc = norm(c);
        const double angle =
            2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
        sum += mesh.face(f).back == piece.region ? angle : -angle;
    }
    return sum / (4.0 * std::numbers::pi);
}

void give_label(EditMesh& mesh, const Piece& piece, RegionId to) {
    mesh.begin();
    for (const FaceId f : piece.faces) {
        Face face = mesh.face(f);
        if (face.back == piece.region)
            face.back = to;
        else
            face.front = to;
        mesh.set_face(f, face);
    }
    mesh.commit();
}

}  // namespace

double region_volume(const EditMesh& mesh, RegionId region) {
    double sum = 0.0;
    Vec3 origin;
    bool first = true;
    for (const FaceId f : mesh.mesh().faces.ids()) {
        if (!mesh.alive(f)) continue;
        const Face& face = mesh.face(f);
        if (face.back != region && face.front != region) continue;
        const auto [a, b, c] = mesh.corners(f);
        if (first) origin = a;
        first = false;
        const double volume = dot(a - origin, cross(b - origin, c - origin)) / 6.0;
        sum += face.back == region ? volume : -volume;
    }
    return sum;
}

// The outer boundaries of one region (positive volume) are its separate parts; its cavities (negative) belong to the
// smallest part that contains them. The largest part keeps the number. Trapped outside air becomes a region too.
void relabel(Workbench& bench) {
    EditMesh& mesh = bench.mesh;
    std::vector<Piece> pieces = pieces_of(mesh);
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.region < b.region; });
    for (std::size_t first = 0; first < pieces.size();) {
        std::size_t last = first;
        while (last < pieces.size() && pieces[last].region == pieces[first].region) ++last;
        const RegionId region = pieces[first].region;
        const bool closed = mesh.regions()[region].kind == RegionKind::kClosed;
        const double target = mesh.regions()[region].target_volume;
        std::vector<Piece*> outer, cavities;
        double whole = 0.0;
        for (std::size_t i = first; i < last; ++i) {
            whole += pieces[i].volume;
            if (pieces[i].open) continue;
            (pieces[i].volume > 0.0 ? outer : cavities).push_back(&pieces[i]);
        }
        first = last;
        std::stable_sort(outer.begin(), outer.end(),
                         [](const Piece* a, const Piece* b) { return a->volume > b->volume; });
        // A cavity goes with the smallest part around it; of an open region, with the open rest.
        std::vector<std::vector<const Piece*>> inside(outer.size());
        if (outer.size() > (closed ? 1U : 0U))
            for (const Piece* cavity : cavities)
                for (std::size_t i = outer.size(); i-- > 0;) {
                    const auto corners = mesh.corners(cavity->faces.front());
                    if (winding(mesh, *outer[i], corners[0]) < 0.5) continue;
                    inside[i].push_back(cavity);
                    break;
                }
        for (std::size_t i = closed ? 1 : 0; i < outer.size(); ++i) {
            double volume = outer[i]->volume;
            for (const Piece* cavity : inside[i]) volume += cavity->volume;
            // The gas is shared by volume, so that both pieces keep the pressure and neither gets less than nothing.
            const double gas = closed ? target * volume / whole : volume;
            const RegionId fresh = mesh.add_region({RegionKind::kClosed, gas});
            if (closed) mesh.regions()[region].target_volume -= gas;
            give_label(mesh, *outer[i], fresh);
            for (const Piece* cavity : inside[i]) give_label(mesh, *cavity, fresh);
            bench.events.push_back(
                {TopologyEvent::Kind::kSplit, mesh.corners(outer[i]->faces.front())[0], region, fresh});
        }
    }
    for (const RegionId r : mesh.regions().ids())
        if (mesh.sides(r) == 0 && mesh.regions()[r].kind == RegionKind::kClosed)
            mesh.regions()[r] = {RegionKind::kGone, 0.0};
}

void absorb(Workbench& bench, RegionId region, RegionId into) {
    EditMesh& mesh = bench.mesh;
    mesh.begin();
    for (const FaceId f : mesh.mesh().faces.ids()) {
        if (!mesh.alive(f)) continue;
        Face face = mesh.face(f);
        if (face.back != region && face.front != region) continue;
        if (face.back == region) face.back = into;
        if (face.front == region) face.front = into;
        if (face.back == face.front)
            mesh.kill_face(f);
        else
            mesh.set_face(f, face);
    }
    mesh.commit();
    Region& gone = mesh.regions()[region];
    Region& heir = mesh.regions()[into];
    if (heir.kind == RegionKind::kClosed) heir.target_volume += gone.target_volume;
    gone = {RegionKind::kGone, 0.0};
    bench.topology_changed = true;
}

void absorb_small_regions(Workbench& bench) {
    EditMesh& mesh = bench.mesh;
    const double least = bench.options.least_volume * std::pow(bench.options.edge_length, 3.0);
    for (const RegionId r : mesh.regions().ids()) {
        if (mesh.regions()[r].kind != RegionKind::kClosed || mesh.sides(r) == 0) continue;
        // A region of this few faces may be small; larger ones cannot be.
        if (mesh.sides(r) > 60 || region_volume(mesh, r) >= least) continue;
        IdVector<RegionId, double> shared(mesh.regions().size(), 0.0);
        Vec3 where;
        for (const FaceId f : mesh.mesh().faces.ids()) {
            if (!mesh.alive(f)) continue;
            const Face& face = mesh.face(f);
            if (face.back != r && face.front != r) continue;
            const auto [a, b, c] = mesh.corners(f);
            shared[face.back == r ? face.front : face.back] += norm(cross(b - a, c - a));
            where = a;
        }
        RegionId heir = kOutside;
        for (const RegionId s : shared.ids())
            if (shared[s] > shared[heir]) heir = s;
        absorb(bench, r, heir);
        bench.events.push_back({TopologyEvent::Kind::kAbsorb, where, r, heir});
        ++bench.report.absorbed;
    }
}

}  // namespace lamella::mesh::detail
