#include "lamella/mesh/shapes/periodic_foam.h"

#include "lamella/mesh/shapes/detail/builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace lamella::mesh {
namespace {

/// Sites in a unit cube.
std::vector<Vec3> sites_of(PeriodicFoam foam) {
    if (foam == PeriodicFoam::kKelvin) return {{{0.0, 0.0, 0.0}}, {{0.5, 0.5, 0.5}}};
    return {{{0.0, 0.0, 0.0}},   {{0.5, 0.5, 0.5}},   {{0.25, 0.0, 0.5}}, {{0.75, 0.0, 0.5}},
            {{0.5, 0.25, 0.0}}, {{0.5, 0.75, 0.0}}, {{0.0, 0.5, 0.25}}, {{0.0, 0.5, 0.75}}};
}

/// One side of a Voronoi cell: its corners, counterclockwise seen from outside, and the neighbor behind it.
struct Side {
    std::vector<Vec3> corner;
    std::size_t neighbor;
    std::array<int, 3> image;
};

/// The polygon in the plane at distance |d|/2 along d, within a square, cut by all other bisectors.
std::vector<Vec3> cut_polygon(const Vec3& site, const Vec3& toward, const std::vector<Vec3>& others) {
    const detail::Axis plane(site + 0.5 * toward, toward);
    std::vector<Vec3> polygon;
    for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
        polygon.push_back(plane.center + x * plane.x + y * plane.y);
    for (const Vec3& d : others) {
        const auto beyond = [&](const Vec3& p) { return dot(p - site, d) - 0.5 * squared_norm(d); };
        std::vector<Vec3> kept;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Vec3 p = polygon[k], q = polygon[(k + 1) % polygon.size()];
            const double a = beyond(p), b = beyond(q);
            if (a <= 1e-12) kept.push_back(p);
            if ((a < -1e-12 && b > 1e-12) || (a > 1e-12 && b < -1e-12)) kept.push_back(p + (a / (a - b)) * (q - p));
        }
        polygon = std::move(kept);
        if (polygon.size() < 3) return {};
    }
    return polygon;
}

/// The sides of one site's cell, among the images of all sites in the neighboring cubes.
std::vector<Side> voronoi_cell(const std::vector<Vec3>& sites, std::size_t i) {
    struct Neighbor {
        Vec3 toward;
        std::size_t site;
        std::array<int, 3> image;
    };
    std::vector<Neighbor> near;
    for (std::size_t j = 0; j < sites.size(); ++j)
        for (int a = -1; a <= 1; ++a)
            for (int b = -1; b <= 1; ++b)
                for (int c = -1; c <= 1; ++c) {
                    const Vec3 d = sites[j] + Vec3{{double(a), double(b), double(c)}} - sites[i];
                    if (norm(d) > 1e-9 && norm(d) < 1.2) near.push_back({d, j, {a, b, c}});
                }
    std::vector<Side> sides;
    for (const Neighbor& n : near) {
        std::vector<Vec3> others;
        for (const Neighbor& m : near)
            if (norm(m.toward - n.toward) > 1e-9) others.push_back(m.toward);
        std::vector<Vec3> polygon = cut_polygon(sites[i], n.toward, others);
        double area = 0.0;
        for (std::size_t k = 2; k < polygon.size(); ++k)
            area += norm(cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]));
        if (area > 1e-6) sides.push_back({std::move(polygon), n.site, n.image});
    }
    return sides;
}

/// Faces whose corners are given anywhere in space; vertices are shared with their images.
class PeriodicBuilder {
public:
    PeriodicBuilder(FoamMesh& mesh, double period) : mesh_(mesh), period_(period) {}

    void add(const std::array<Vec3, 3>& corner, RegionId back, RegionId front) {
        std::array<VertexId, 3> ids;
        CornerImages images{};
        for (std::size_t k = 0; k < 3; ++k) {
            ids[k] = vertex(corner[k]);
            const Vec3 apart = (corner[k] - mesh_.position[ids[k]]) / period_;
            for (std::size_t a = 0; a < 3; ++a) images[k][a] = static_cast<std::int8_t>(std::lround(apart[a]));
        }
        mesh_.add_face(ids[0], ids[1], ids[2], back, front);
        mesh_.images.push_back(images);
    }

private:
    VertexId vertex(const Vec3& place) {
        constexpr long long kGrid = 10'000'000;  // to a period: what differs by less is one place
        std::array<long long, 3> key;
        Vec3 wrapped;
        for (std::size_t a = 0; a < 3; ++a) {
            const double whole = std::floor(place[a] / period_ + 0.5 / static_cast<double>(kGrid));
            wrapped[a] = place[a] - whole * period_;
            key[a] = std::llround(wrapped[a] / period_ * static_cast<double>(kGrid)) % kGrid;
        }
        const auto [it, fresh] = known_.try_emplace(key, kNoVertex);
        if (fresh) it->second = mesh_.add_vertex(wrapped);
        return it->second;
    }

    FoamMesh& mesh_;
    double period_;
    std::map<std::array<long long, 3>, VertexId> known_;
};

}  // namespace

FoamMesh periodic_foam(PeriodicFoam foam, double volume, double edge_length) {
    detail::require_positive(volume, "volume of a bubble");
    detail::require_positive(edge_length, "edge length");
    const std::vector<Vec3> sites = sites_of(foam);
    const double period = std::cbrt(volume * static_cast<double>(sites.size()));
    detail::require_affordable(2.7 * std::pow(volume, 2.0 / 3.0) * static_cast<double>(sites.size()), edge_length);
    FoamMesh mesh = detail::empty_mesh(sites.size(), RegionKind::kClosed);
    for (const RegionId r : mesh.regions.ids())
        if (r != kOutside) mesh.regions[r].target_volume = volume;
    for (std::size_t a = 0; a < 3; ++a) mesh.period[a][a] = period;

    PeriodicBuilder builder(mesh, period);
    for (std::size_t i = 0; i < sites.size(); ++i)
        for (const Side& side : voronoi_cell(sites, i)) {
            constexpr std::array<int, 3> kSameImage{};
            if (std::tie(side.neighbor, side.image) < std::tie(i, kSameImage)) continue;  // seen from there
            Vec3 middle;
            for (const Vec3& p : side.corner) middle += p / static_cast<double>(side.corner.size());
            // The same number of pieces on every edge, so that sides fit together.
            const double spoke = 0.35 * period * std::cbrt(2.0 / static_cast<double>(sites.size()));
            const int n = std::max(1, static_cast<int>(std::lround(spoke / edge_length)));
            for (std::size_t k = 0; k < side.corner.size(); ++k) {
                const Vec3 p = side.corner[k], q = side.corner[(k + 1) % side.corner.size()];
                const auto at = [&](int u, int v) {
                    return period * (middle + (static_cast<double>(u) / n) * (p - middle) +
                                     (static_cast<double>(v) / n) * (q - middle));
                };
                const auto back = static_cast<RegionId>(i + 1), front = static_cast<RegionId>(side.neighbor + 1);
                for (int v = 0; v < n; ++v)
                    for (int u = 0; u + v < n; ++u) {
                        builder.add({at(u, v), at(u + 1, v), at(u, v + 1)}, back, front);
                        if (u + v + 1 < n) builder.add({at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)}, back, front);
                    }
            }
        }
    return mesh;
}

}  // namespace lamella::mesh
