#include "lamella/solvers/vortex_particle/rebin.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/geometry/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace lamella::vortex_particle {
namespace {

using mesh::FaceId;
using mesh::RegionId;
using mesh::VertexId;

/// Which region each one is now, after splits, absorptions and bursts.
class Heirs {
public:
    explicit Heirs(std::span<const mesh::TopologyEvent> events) {
        using Kind = mesh::TopologyEvent::Kind;
        for (const mesh::TopologyEvent& event : events)
            if (event.kind == Kind::kAbsorb || event.kind == Kind::kPop) heir_[event.a] = event.b;
    }
    RegionId of(RegionId r) const {
        constexpr int kDeepest = 100;
        for (int depth = 0; depth < kDeepest; ++depth) {
            const auto at = heir_.find(r);
            if (at == heir_.end()) break;
            r = at->second;
        }
        return r;
    }

private:
    std::map<RegionId, RegionId> heir_;
};

/// The leaves of each face.
std::vector<std::array<std::uint32_t, 2>> leaves_of(const Laid& laid) {
    std::vector<std::array<std::uint32_t, 2>> leaves(laid.films.faces.size(),
                                                     {Relaid::kNoTriangle, Relaid::kNoTriangle});
    for (std::uint32_t t = 0; t < laid.surface.triangles(); ++t) leaves[laid.surface.film[t]][laid.surface.side[t]] = t;
    return leaves;
}

/// Whether a face is where and what it was.
bool same(const Laid& before, FaceId old, const Laid& now, FaceId face, const mesh::CompactionMaps& maps) {
    for (std::size_t k = 0; k < 3; ++k) {
        const VertexId v = before.films.faces[old].vertices[k], w = now.films.faces[face].vertices[k];
        if (maps.vertex[v] != w || !(before.films.position[v] == now.films.position[w])) return false;
    }
    return true;
}

}  // namespace

Relaid relaid(const Laid& before,
              const Laid& now,
              const mesh::CompactionMaps& maps,
              std::span<const mesh::TopologyEvent> events) {
    const Heirs heirs(events);
    const auto leaves = leaves_of(now);
    Relaid edit{std::vector<std::uint32_t>(before.surface.triangles(), Relaid::kNoTriangle),
                std::vector<std::uint8_t>(now.surface.triangles(), 0),
                std::vector<std::uint8_t>(now.surface.vertices(), 1),
                std::vector<std::uint32_t>(before.surface.triangles(), kNoRegion)};
    std::vector<std::uint8_t> fresh(now.films.position.size(), 0), known(now.surface.triangles(), 0);
    for (std::size_t t = 0; t < before.surface.triangles(); ++t) {
        const auto old = static_cast<FaceId>(before.surface.film[t]);
        const FaceId face = maps.face[old];
        if (before.surface.region[t] != kNoRegion)
            edit.region[t] =
                static_cast<std::uint32_t>(index(heirs.of(static_cast<RegionId>(before.surface.region[t]))));
        const bool stays = face != mesh::kNoFace && same(before, old, now, face, maps);
        std::uint32_t leaf = stays ? leaves[index(face)][before.surface.side[t]] : Relaid::kNoTriangle;
        if (stays && leaf == Relaid::kNoTriangle && before.surface.partner[t] == kNoPartner) {
            leaf = leaves[index(face)][1U - before.surface.side[t]];
            if (leaf != Relaid::kNoTriangle) edit.turned[leaf] = 1;
        }
        if (leaf != Relaid::kNoTriangle) {
            edit.kept[t] = leaf;
            known[leaf] = 1;
            continue;
        }
        for (const VertexId v : before.films.faces[old].vertices)
            if (maps.vertex[v] != mesh::kNoVertex) fresh[index(maps.vertex[v])] = 1;
    }
    for (std::size_t t = 0; t < now.surface.triangles(); ++t)
        if (known[t] == 0)
            for (const std::uint32_t v : now.surface.corner[t]) fresh[now.surface.site[v]] = 1;
    for (std::size_t v = 0; v < now.surface.vertices(); ++v) edit.touched[v] = fresh[now.surface.site[v]];
    return edit;
}

Bins rebin(const Laid& before, const Laid& now, const Relaid& edit, Particles& particles) {
    const Surface& s = now.surface;
    std::vector<std::uint32_t> candidates;
    for (std::uint32_t t = 0; t < s.triangles(); ++t)
        if (std::any_of(s.corner[t].begin(), s.corner[t].end(), [&](std::uint32_t v) { return edit.touched[v] != 0; }))
            candidates.push_back(t);
    if (candidates.empty())  // what has burst touched nothing that is left
        for (std::uint32_t t = 0; t < s.triangles(); ++t) candidates.push_back(t);
    if (candidates.empty()) throw NumericalError("vortex_particle: no film is left that the liquid could lie on");
    parallel_for(particles.size(), [&](std::size_t p) {
        const std::uint32_t from = particles.triangle[p];
        if (edit.kept[from] != Relaid::kNoTriangle) {
            particles.triangle[p] = edit.kept[from];
            if (edit.turned[edit.kept[from]] != 0) {
                std::swap(particles.place[p][1], particles.place[p][2]);
                particles.circulation[p] = -particles.circulation[p];
            }
            return;
        }
        const Vec3 x = before.surface.point(from, particles.place[p]), n = before.surface.normal[from];
        double best = std::numeric_limits<double>::infinity();
        std::uint32_t to = candidates[0];
        std::array<double, 3> place{};
        for (const std::uint32_t t : candidates) {
            const auto& [a, b, c] = s.corner[t];
            const geometry::NearestOnTriangle near =
                geometry::nearest_on_triangle(x, s.position[a], s.position[b], s.position[c]);
            const std::array<double, 3> at{near.u, near.v, near.w};
            // Its own bubble's leaf goes first, and one that faces as it did.
            constexpr double kOther = 100.0, kTurned = 10.0;  // edges
            const double detour = (s.region[t] == edit.region[from] ? 0.0 : kOther * s.mean_edge) +
                                  ((dot(s.normal[t], n) > 0.0) != (edit.turned[t] != 0) ? 0.0 : kTurned * s.mean_edge);
            const double distance = norm(s.point(t, at) - x) + detour;
            if (!(distance < best)) continue;
            best = distance;
            to = t;
            place = at;
        }
        particles.triangle[p] = to;
        particles.place[p] = place;
        if (edit.turned[to] != 0) particles.circulation[p] = -particles.circulation[p];
        Vec3& u = particles.velocity[p];
        constexpr double kFolded = -0.9;
        if (dot(n, s.normal[to]) > kFolded) u = turned(u, n, s.normal[to]);
        u -= dot(u, s.normal[to]) * s.normal[to];
    });
    return sort_by_triangle(particles, s.triangles());
}

void fit_areas(const Surface& s,
               const Transfer& transfer,
               const Bins& bins,
               const std::vector<std::uint8_t>& touched,
               Particles& particles) {
    constexpr int kSweeps = 5;
    // What came to changed triangles has a share in their other corners too, which have to be right again.
    std::vector<std::uint8_t> near = touched;
    for (const auto& corners : s.corner)
        if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return touched[v] != 0; }))
            for (const std::uint32_t v : corners) near[v] = 1;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        std::vector<double> factor = transfer.deposit(s, particles, bins, particles.area);
        for (std::size_t v = 0; v < factor.size(); ++v)
            factor[v] = near[v] != 0 && factor[v] > 0.0 ? s.vertex_area[v] / factor[v] : 1.0;
        const std::vector<double> change = transfer.gather(s, particles, factor);
        for (std::size_t p = 0; p < particles.size(); ++p) particles.area[p] *= change[p];
    }
}

void balance_circulation(const Surface& s, const Bins& bins, Particles& particles) {
    std::vector<double> surplus(s.components, 0.0), area(s.components, 0.0);
    const auto component = [&](std::size_t t) { return s.component[s.corner[t][0]]; };
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (std::size_t p = bins[t]; p < bins[t + 1]; ++p) {
            surplus[component(t)] += particles.circulation[p];
            area[component(t)] += particles.area[p];
        }
    for (const BoundaryLoop& loop : s.loops) surplus[loop.component] = 0.0;
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (std::size_t p = bins[t]; p < bins[t + 1]; ++p)
            particles.circulation[p] -= surplus[component(t)] / area[component(t)] * particles.area[p];
}

}  // namespace lamella::vortex_particle
