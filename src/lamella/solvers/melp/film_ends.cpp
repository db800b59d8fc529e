#include "lamella/solvers/melp/film_ends.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace lamella::melp {
namespace {

/// Edges of one triangle only, with the film on their left.
std::vector<std::pair<std::uint32_t, std::uint32_t>> free_edges(const Triangles& triangles) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, free;
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
    std::sort(edges.begin(), edges.end());
    std::copy_if(edges.begin(), edges.end(), std::back_inserter(free), [&](const auto& edge) {
        return !std::binary_search(edges.begin(), edges.end(), std::pair(edge.second, edge.first));
    });
    return free;
}

/// Where two wires meet; nothing where they do not.
std::optional<Vec3> common_end(const RimPiece& a, const RimPiece& b) {
    if (a.kind != RimKind::kLine || b.kind != RimKind::kLine) return std::nullopt;
    const double near = 1e-6 * norm(a.b - a.a);
    for (const Vec3& end : {a.a, a.b})
        if (norm(end - b.a) < near || norm(end - b.b) < near) return end;
    return std::nullopt;
}

/// Feet of particles, each made when it is first asked for.
class Feet {
public:
    Feet(const CoarseParticles& coarse, std::span<const RimPiece> rims, double reach, FilmEnds* ends)
        : coarse_(coarse), rims_(rims), reach_(reach), ends_(ends) {}

    /// The number of the particle's foot; nothing where no rim is near.
    std::optional<std::uint32_t> of(std::uint32_t particle) {
        if (const auto known = own_.find(particle); known != own_.end()) return known->second;
        const Vec3& x = coarse_.position[particle];
        double nearest = reach_;
        std::optional<FilmEnds::Foot> foot;
        for (std::uint32_t k = 0; k < rims_.size(); ++k) {
            if (rims_[k].region != coarse_.region[particle]) continue;
            const std::optional<Vec3> at = rims_[k].foot(x);
            if (!at || norm(*at - x) >= nearest) continue;
            nearest = norm(*at - x);
            foot = {*at, particle, k};
        }
        std::optional<std::uint32_t> number;
        if (foot) number = add(*foot);
        return own_[particle] = number;
    }
    /// The corner between the wires of two feet, if they are on two that meet.
    std::optional<std::uint32_t> corner(std::uint32_t a, std::uint32_t b) {
        const FilmEnds::Foot from = at(a), to = at(b);
        if (from.piece == to.piece) return std::nullopt;
        const std::optional<Vec3> end = common_end(rims_[from.piece], rims_[to.piece]);
        if (!end || norm(*end - coarse_.position[from.particle]) > 2.0 * reach_) return std::nullopt;
        return add({*end, from.particle, from.piece});
    }
    const FilmEnds::Foot& at(std::uint32_t number) const { return ends_->feet[number - coarse_.size()]; }

private:
    std::uint32_t add(const FilmEnds::Foot& foot) {
        ends_->feet.push_back(foot);
        return static_cast<std::uint32_t>(coarse_.size() + ends_->feet.size() - 1);
    }

    const CoarseParticles& coarse_;
    std::span<const RimPiece> rims_;
    double reach_;
    FilmEnds* ends_;
    std::map<std::uint32_t, std::optional<std::uint32_t>> own_;
};

}  // namespace

FilmEnds film_ends(const CoarseParticles& coarse,
                   const Triangles& triangles,
                   std::span<const RimPiece> rims,
                   double reach) {
    FilmEnds ends;
    if (rims.empty()) return ends;
    Feet feet(coarse, rims, reach, &ends);
    for (const auto& [a, b] : free_edges(triangles)) {
        const auto foot_a = feet.of(a), foot_b = feet.of(b);
        if (!foot_a || !foot_b) continue;
        const Vec3 edge = coarse.position[b] - coarse.position[a];
        const auto corner = feet.corner(*foot_a, *foot_b);
        constexpr double kAlong = 0.3;  // less: the edge of a hole, which runs toward the rim
        if (!corner && dot(feet.at(*foot_b).position - feet.at(*foot_a).position, edge) < kAlong * squared_norm(edge))
            continue;
        ends.triangles.push_back({b, a, *foot_a});
        if (corner) ends.triangles.push_back({b, *foot_a, *corner});
        ends.triangles.push_back({b, corner ? *corner : *foot_a, *foot_b});
    }
    return ends;
}

}  // namespace lamella::melp
