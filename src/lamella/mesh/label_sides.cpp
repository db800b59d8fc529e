#include "lamella/mesh/label_sides.h"

#include "lamella/core/error.h"
#include "lamella/spatial/bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace lamella::mesh {
namespace {

/// Sets of numbers that are joined two by two; the smallest number of a set stands for it.
class Sets {
public:
    explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
    std::size_t of(std::size_t x) {
        while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
        return x;
    }
    void join(std::size_t a, std::size_t b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::size_t> parent_;
};

// Side 2 f is the back of face f, 2 f + 1 its front.
std::size_t back_of(FaceId f) { return 2 * index(f); }
std::size_t front_of(FaceId f) { return 2 * index(f) + 1; }
FaceId face_of(std::size_t side) { return static_cast<FaceId>(side / 2); }
RegionId region_of(const FoamMesh& mesh, std::size_t side) {
    const Face& face = mesh.faces[face_of(side)];
    return side % 2 == 0 ? face.back : face.front;
}

/// The faces around an edge in order of their angle, seen along it.
std::vector<EdgeUse> around(const FoamMesh& mesh, std::span<const EdgeUse> uses) {
    const Vec3 along = edge_vector(mesh, uses[0]);
    const double length = norm(along);
    if (!(length > 0.0)) return {uses.begin(), uses.end()};
    const Vec3 axis = along / length;
    const auto away = [&](const EdgeUse& use) {
        const Vec3 w = mesh.corner(use.face, use.opposite) - mesh.corner(use.face, (use.opposite + 1) % 3);
        return w - dot(w, axis) * axis;
    };
    const Vec3 zero = away(uses[0]);
    const Vec3 quarter = cross(axis, zero);
    std::vector<std::pair<double, EdgeUse>> sorted;
    for (const EdgeUse& use : uses) {
        const Vec3 w = away(use);
        sorted.emplace_back(std::atan2(dot(w, quarter), dot(w, zero)), use);
    }
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<EdgeUse> ordered;
    for (const auto& entry : sorted) ordered.push_back(entry.second);
    return ordered;
}

/// A face that runs along the edge has its front on the side of growing angles.
Sets sides_of_one_gas(const FoamMesh& mesh, const EdgeFaces& edges) {
    Sets sides(2 * mesh.faces.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges.of(e).size() < 2) continue;
        const std::vector<EdgeUse> uses = around(mesh, edges.of(e));
        for (std::size_t k = 0; k < uses.size(); ++k) {
            const EdgeUse& use = uses[k];
            const EdgeUse& next = uses[(k + 1) % uses.size()];
            sides.join(use.forward ? front_of(use.face) : back_of(use.face),
                       next.forward ? back_of(next.face) : front_of(next.face));
        }
    }
    return sides;
}

std::string region_text(RegionId r) {
    return r == kNoRegion ? "no region" : fmt::format("region {}", index(r));
}

void require_agreement(const FoamMesh& mesh, Sets& sides, const ElementNames& names) {
    for (const FaceId f : mesh.faces.ids())
        if (sides.of(back_of(f)) == sides.of(front_of(f)))
            throw InputError(fmt::format("face {} has the same gas on both sides", names.of(f)));
    for (std::size_t side = 0; side < 2 * mesh.faces.size(); ++side) {
        const std::size_t first = sides.of(side);
        const RegionId a = region_of(mesh, first), b = region_of(mesh, side);
        if (a != b)
            throw InputError(fmt::format("faces {} and {} look at the same gas, but one names {} there, the other {}",
                                         names.of(face_of(first)), names.of(face_of(side)), region_text(a),
                                         region_text(b)));
    }
}

/// What tells the outside of a connected piece of films from the regions in it.
struct Candidate {
    double volume = 0.0;  ///< of the cones from the piece's middle to the sides
    double size = 0.0;    ///< the same, each counted positive
    long fronts = 0;      ///< faces in front of which it lies, minus those behind which it does

    bool before(const Candidate& other) const {
        const double noise = 1e-9 * std::max(size, other.size);
        if (std::abs(volume - other.volume) > noise) return volume < other.volume;
        return fronts > other.fronts;
    }
};

/// Share of the full sphere that the faces of a region cover, seen from x: 1 inside of it, 0 outside.
double winding(const FoamMesh& mesh, const std::vector<std::size_t>& sides, const Vec3& x) {
    constexpr double kFullSphere = 12.566370614359172;
    double angle = 0.0;
    for (const std::size_t side : sides) {
        const FaceId f = face_of(side);
        const Vec3 a = mesh.corner(f, 0) - x, b = mesh.corner(f, 1) - x, c = mesh.corner(f, 2) - x;
        const double la = norm(a), lb = norm(b), lc = norm(c);
        const double solid = 2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
        angle += side % 2 == 0 ? solid : -solid;
    }
    return angle / kFullSphere;
}

/// Pieces whose outside was found must lie outside: inside a closed region of other films, which region is around them
/// only a label could say.
void require_outside(const FoamMesh& mesh, const EdgeFaces& edges, Sets& pieces, const std::map<std::size_t, FaceId>& found,
                     const ElementNames& names) {
    const auto closed = closed_in(mesh, edges);
    std::map<RegionId, std::vector<std::size_t>> sides;
    for (std::size_t side = 0; side < 2 * mesh.faces.size(); ++side)
        if (const RegionId r = region_of(mesh, side); closed[r] != 0) sides[r].push_back(side);
    std::vector<RegionId> regions;
    std::vector<spatial::Bounds> boxes;
    for (const auto& [r, own] : sides) {
        spatial::Bounds box{mesh.corner(face_of(own[0]), 0), mesh.corner(face_of(own[0]), 0)};
        for (const std::size_t side : own)
            for (std::size_t k = 0; k < 3; ++k) box.enclose({mesh.corner(face_of(side), k), mesh.corner(face_of(side), k)});
        regions.push_back(r);
        boxes.push_back(box);
    }
    if (boxes.empty()) return;
    const spatial::BoxTree tree(boxes);
    for (const auto& [piece, face] : found) {
        const Vec3 x = mesh.corner(face, 0);
        tree.query({x, x}, [&, piece = piece, face = face](std::size_t k) {
            const std::vector<std::size_t>& around_it = sides.at(regions[k]);
            const bool own = std::any_of(around_it.begin(), around_it.end(), [&](std::size_t side) {
                return pieces.of(index(mesh.faces[face_of(side)].vertices[0])) == piece;
            });
            if (!own && winding(mesh, around_it, x) > 0.5)
                throw InputError(fmt::format("face {} lies inside region {}, behind face {}, but no label says which region"
                                             " is around it", names.of(face), index(regions[k]),
                                             names.of(face_of(around_it[0]))));
            return true;
        });
    }
}

}  // namespace

void label_sides(FoamMesh& mesh, const EdgeFaces& edges, const ElementNames& names) {
    Sets sides = sides_of_one_gas(mesh, edges);
    require_agreement(mesh, sides, names);

    Sets pieces(mesh.position.size());
    for (const Face& face : mesh.faces)
        for (const VertexId v : face.vertices) pieces.join(index(face.vertices[0]), index(v));
    const auto piece_of = [&](FaceId f) { return pieces.of(index(mesh.faces[f].vertices[0])); };
    std::map<std::size_t, std::pair<Vec3, double>> middles;
    for (const FaceId f : mesh.faces.ids()) {
        auto& [sum, count] = middles[piece_of(f)];
        for (std::size_t k = 0; k < 3; ++k) sum += mesh.corner(f, k);
        count += 3.0;
    }
    std::map<std::size_t, std::map<std::size_t, Candidate>> unnamed;  // piece -> first side -> what it looks like
    for (std::size_t side = 0; side < 2 * mesh.faces.size(); ++side) {
        if (region_of(mesh, side) != kNoRegion) continue;
        const FaceId f = face_of(side);
        const auto& [sum, count] = middles.at(piece_of(f));
        const Vec3 c = sum / count;
        const double cone = dot(mesh.corner(f, 0) - c, cross(mesh.corner(f, 1) - c, mesh.corner(f, 2) - c)) / 6.0;
        Candidate& candidate = unnamed[piece_of(f)][sides.of(side)];
        candidate.volume += side % 2 == 0 ? cone : -cone;
        candidate.size += std::abs(cone);
        candidate.fronts += side % 2 == 0 ? -1 : 1;
    }
    std::map<std::size_t, RegionId> region;
    std::map<std::size_t, FaceId> found;  // piece -> a face at its outside
    for (const auto& [piece, candidates] : unnamed) {
        const auto outside = std::min_element(candidates.begin(), candidates.end(),
                                              [](const auto& a, const auto& b) { return a.second.before(b.second); });
        region[outside->first] = kOutside;
        found[piece] = face_of(outside->first);
    }
    for (std::size_t side = 0; side < 2 * mesh.faces.size(); ++side) {
        if (region_of(mesh, side) != kNoRegion) continue;
        const auto [it, fresh] = region.try_emplace(sides.of(side), kOutside);
        if (fresh) it->second = mesh.regions.push_back({RegionKind::kOpen, 0.0});
        Face& face = mesh.faces[face_of(side)];
        (side % 2 == 0 ? face.back : face.front) = it->second;
    }
    if (!mesh.periodic()) require_outside(mesh, edges, pieces, found, names);
}

IdVector<RegionId, std::uint8_t> closed_in(const FoamMesh& mesh, const EdgeFaces& edges) {
    IdVector<RegionId, std::uint8_t> closed(mesh.regions.size(), 0);
    for (const Face& face : mesh.faces) closed[face.back] = closed[face.front] = 1;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        std::map<RegionId, int> sum;
        for (const EdgeUse& use : edges.of(e)) {
            const Face& face = mesh.faces[use.face];
            sum[face.back] += use.forward ? 1 : -1;
            sum[face.front] -= use.forward ? 1 : -1;
        }
        for (const auto& [r, count] : sum)
            if (count != 0) closed[r] = 0;
    }
    closed[kOutside] = 0;
    return closed;
}

}  // namespace lamella::mesh
