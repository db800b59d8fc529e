#include "lamella/geometry/triangle_intersection.h"
#include "lamella/mesh/detail/candidate_edges.h"
#include "lamella/mesh/detail/face_shape.h"
#include "lamella/mesh/detail/sectors.h"
#include "lamella/mesh/detail/workbench.h"

#include <algorithm>
#include <functional>

namespace lamella::mesh::detail {
namespace {

/// Edges shorter than allowed, or opposite a very sharp angle; shortest first.
std::vector<CandidateEdge> short_edges(const Workbench& bench) {
    static const double kSharp = cot_of_degrees(10.0);
    const EditMesh& mesh = bench.mesh;
    const double shortest = bench.length(bench.options.shortest_edge);
    const double opposite_sharp = bench.length(1.0);
    return candidate_edges(
        mesh,
        [&](double squared, VertexId v, VertexId w, VertexId opposite) {
            if (squared < shortest * shortest) return true;
            return squared <= opposite_sharp * opposite_sharp &&
                   cot_at(mesh.at(opposite), mesh.at(v), mesh.at(w)) >= kSharp;
        },
        std::less<>());
}

using RegionList = SmallVector<RegionId, 8>;

template <class Faces>
RegionList regions_of(const EditMesh& mesh, const Faces& faces) {
    RegionList regions;
    for (const FaceId f : faces)
        for (const RegionId r : {mesh.face(f).back, mesh.face(f).front})
            if (!regions.contains(r)) regions.push_back(r);
    return regions;
}

/// How a vertex is bound: on a wire, at a junction, on a triple line, inside a film. The more bound one stays.
int rank(const EditMesh& mesh, VertexId v) {
    return mesh.on_wire(v) ? 1000 : static_cast<int>(regions_of(mesh, mesh.faces_at(v)).size());
}

SmallVector<VertexId, 12> neighbors(const EditMesh& mesh, VertexId v) {
    SmallVector<VertexId, 12> around;
    for (const FaceId f : mesh.faces_at(v))
        for (const VertexId w : mesh.face(f).vertices)
            if (w != v && !around.contains(w)) around.push_back(w);
    return around;
}

struct MovingFace {
    FaceId face;
    Vec3 normal;  // twice the area
};

class Collapse {
public:
    /// Of edge v - w; the more bound end is `kept`.
    Collapse(Workbench& bench, VertexId v, VertexId w);
    bool run();

private:
    bool try_at(const Vec3& place, double weight_of_gone);
    bool moors_a_region() const;
    bool turns_too_far() const;
    bool sweeps_through_film(VertexId v, const Vec3& from, const Vec3& to) const;
    bool stays_regular();
    bool undoes_itself(const TopologyEvent& parted) const;
    std::optional<Separation> separate(double sharpest);

    Workbench& bench_;
    EditMesh& mesh_;
    VertexId kept_, gone_;
    Vec3 kept_at_, gone_at_;
    double length_;
    bool same_rank_;
    double sharpest_before_ = 0.0;
    std::vector<FaceId> star_;
    std::vector<MovingFace> surviving_;
    SmallVector<VertexId, 8> common_;
    RegionList beyond_kept_, beyond_gone_;  // regions at one end of the edge and not around it
    StarVolumes volumes_;
};

Collapse::Collapse(Workbench& bench, VertexId v, VertexId w) : bench_(bench), mesh_(bench.mesh), kept_(v), gone_(w) {
    const int rank_v = rank(mesh_, v);
    const int rank_w = rank(mesh_, w);
    if (rank_w > rank_v) std::swap(kept_, gone_);
    same_rank_ = rank_v == rank_w;
    kept_at_ = mesh_.at(kept_);
    gone_at_ = mesh_.at(gone_);
    length_ = norm(gone_at_ - kept_at_);
    for (const VertexId end : {kept_, gone_})
        for (const FaceId f : mesh_.faces_at(end)) {
            const bool both = mesh_.face(f).has(kept_) && mesh_.face(f).has(gone_);
            if (both && end == gone_) continue;
            star_.push_back(f);
            sharpest_before_ = std::max(sharpest_before_, sharpest_cot(mesh_.corners(f)));
            if (!both) surviving_.push_back({f, area_vector(mesh_.corners(f))});
            if (both)
                for (const VertexId u : mesh_.face(f).vertices)
                    if (u != kept_ && u != gone_) common_.push_back(u);
        }
    volumes_ = star_volumes(mesh_, star_, kept_at_);
    const RegionList around = regions_of(mesh_, mesh_.faces_on(kept_, gone_));
    const auto beyond = [&](VertexId end) {
        RegionList regions;
        for (const RegionId r : regions_of(mesh_, mesh_.faces_at(end)))
            if (!around.contains(r)) regions.push_back(r);
        return regions;
    };
    beyond_kept_ = beyond(kept_);
    beyond_gone_ = beyond(gone_);
}

bool Collapse::run() {
    if (mesh_.on_wire(kept_)) return !moors_a_region() && try_at(kept_at_, 0.0);
    if (!same_rank_) return try_at(kept_at_, 0.0);
    return try_at(0.5 * (kept_at_ + gone_at_), 0.5) || try_at(kept_at_, 0.0) || try_at(gone_at_, 1.0);
}

/// The wire vertex that stays would come to lie at a region that it did not touch: a triple line would hop onto the wire,
/// or along it from where it ends, and nothing parts vertices of wires again.
bool Collapse::moors_a_region() const {
    const RegionList at_wire = regions_of(mesh_, mesh_.faces_at(kept_));
    for (const RegionId r : beyond_gone_)
        if (!at_wire.contains(r)) return true;
    return false;
}

bool Collapse::turns_too_far() const {
    constexpr double kCos78 = 0.2079;
    for (const MovingFace& before : surviving_) {
        if (!mesh_.alive(before.face)) continue;
        const Vec3 now = area_vector(mesh_.corners(before.face));
        if (dot(now, before.normal) < kCos78 * norm(now) * norm(before.normal)) return true;
    }
    return false;
}

/// Whether the triangle that edge v - w sweeps meets a face that touches neither end nor w, for any neighbor w.
bool Collapse::sweeps_through_film(VertexId v, const Vec3& from, const Vec3& to) const {
    if (squared_norm(to - from) < 1e-20 * length_ * length_) return false;
    const auto around = neighbors(mesh_, v);
    Box all{from, from};
    all.include(to);
    for (const VertexId w : around) all.include(mesh_.at(w));
    SmallVector<FaceId, 16> near;
    mesh_.grid().query(all, [&](FaceId f) {
        if (mesh_.alive(f) && !mesh_.is_touched(f)) near.push_back(f);
    });
    for (const VertexId w : around) {
        const std::array<Vec3, 3> swept{from, to, mesh_.at(w)};
        Box box{from, from};
        box.include(to);
        box.include(mesh_.at(w));
        for (const FaceId f : near) {
            if (mesh_.face(f).has(w) || !box.overlaps(mesh_.grid().box(f))) continue;
            if (geometry::triangles_meet(swept, mesh_.corners(f))) return true;
        }
    }
    return false;
}

/// All vertices whose surroundings changed are regular.
bool Collapse::stays_regular() {
    if (!mesh_.faces_at(kept_).empty() && !is_regular(mesh_, kept_)) return false;
    for (const VertexId v : common_)
        if (!mesh_.faces_at(v).empty() && !is_regular(mesh_, v)) return false;
    return true;
}

/// A separation of what the two ends had beyond the edge gives the edge back: nothing happened but a longer edge.
bool Collapse::undoes_itself(const TopologyEvent& parted) const {
    if (parted.kind != TopologyEvent::Kind::kT1) return false;
    return (beyond_kept_.contains(parted.a) && beyond_gone_.contains(parted.b)) ||
           (beyond_kept_.contains(parted.b) && beyond_gone_.contains(parted.a));
}

/// An irregular collapse is the first half of a T1: the other half is tried at once.
std::optional<Separation> Collapse::separate(double sharpest) {
    const auto part = [&](VertexId v) -> std::optional<Separation> {
        if (mesh_.faces_at(v).empty() || mesh_.on_wire(v) || is_regular(mesh_, v)) return std::nullopt;
        const std::size_t mark = mesh_.mark();
        auto parted = separate_vertex(bench_, v, volumes_, kept_at_, sharpest);
        if (!parted || !undoes_itself(parted->event)) return parted;
        mesh_.rollback_to(mark);
        return std::nullopt;
    };
    auto parted = part(kept_);
    for (std::size_t i = 0; i < common_.size() && !parted; ++i) parted = part(common_[i]);
    return parted;
}

bool Collapse::try_at(const Vec3& place, double weight_of_gone) {
    static const double kSharpest = cot_of_degrees(6.0);
    static const double kSharpestOfShort = cot_of_degrees(2.0);
    const bool tiny = length_ < bench_.length(bench_.options.irregular_edge);
    const double sharpest = std::max(tiny ? kSharpestOfShort : kSharpest, 1.001 * sharpest_before_);
    mesh_.begin();
    if (!identify(mesh_, kept_, gone_, place)) {
        mesh_.rollback();
        return false;
    }
    const bool regular = stays_regular();
    if (!regular && (!tiny || mesh_.on_wire(kept_) || !bench_.options.separating)) {
        mesh_.rollback();
        return false;
    }
    std::optional<Separation> parted;
    if (!regular) parted = separate(sharpest);
    if (!parted) {
        // A crossing that cannot be parted now is kept only in place of an edge too short to live with.
        const bool keep = regular || length_ < bench_.length(bench_.options.kept_irregular_edge);
        if (keep && !mesh_.on_wire(kept_))
            restore_volumes(mesh_, kept_, volumes_, kept_at_, 0.25 * bench_.options.edge_length);
        const Vec3 now = mesh_.at(kept_);
        if (!keep || (!tiny && turns_too_far()) || !acceptable(mesh_, sharpest) ||
            sweeps_through_film(kept_, kept_at_, now) || sweeps_through_film(kept_, gone_at_, now)) {
            mesh_.rollback();
            return false;
        }
    }
    mesh_.commit();
    bench_.resample(kept_, {kept_, gone_}, {1.0 - weight_of_gone, weight_of_gone});
    ++bench_.report.collapses;
    if (parted) {
        bench_.resample(parted->copy, {parted->vertex}, {1.0});
        bench_.events.push_back(parted->event);
        ++bench_.report.separations;
    }
    if (!regular) bench_.topology_changed = true;
    return true;
}

}  // namespace

void collapse_short_edges(Workbench& bench) {
    EditMesh& mesh = bench.mesh;
    for (const CandidateEdge& edge : short_edges(bench)) {
        if (mesh.faces_on(edge.v, edge.w).empty()) continue;
        // An earlier collapse may have moved an end.
        const double squared = squared_norm(mesh.at(edge.v) - mesh.at(edge.w));
        if (squared > bench.length(1.0) * bench.length(1.0)) continue;
        Collapse(bench, edge.v, edge.w).run();
    }
}

}  // namespace lamella::mesh::detail
