#include "lamella/solvers/vortex_sheet/loose_sheets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lamella::vortex_sheet {
namespace {

using mesh::FaceId;
using mesh::VertexId;

// Of the triangles that a burst leaves: so many times as many may become of them.
constexpr std::size_t kMostGrowth = 8;

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edge_of(const Triangle& t, std::size_t k) { return std::minmax(t[k], t[(k + 1) % 3]); }

Vec3 area_vector(const LooseSheets& sheets, const Triangle& t) {
    const Vec3& a = sheets.position[t[0]];
    return 0.5 * cross(sheets.position[t[1]] - a, sheets.position[t[2]] - a);
}

/// The parts of a triangle of which some edges are halved (edge k goes from corner k to the next). Its points are the
/// corners 0 to 2 and the middles of the edges, 3 to 5.
std::vector<std::array<std::size_t, 3>> parts_of(const std::array<bool, 3>& halved) {
    const auto count = std::count(halved.begin(), halved.end(), true);
    if (count == 0) return {{0, 1, 2}};
    if (count == 3) return {{0, 3, 5}, {1, 4, 3}, {2, 5, 4}, {3, 4, 5}};
    // Turned such that the first edge is halved and, of two, the last is not.
    std::size_t a = 0;
    while (!halved[a] || (count == 2 && halved[(a + 2) % 3])) ++a;
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3, ab = 3 + a, bc = 3 + b;
    if (count == 1) return {{a, ab, c}, {ab, b, c}};
    return {{a, ab, c}, {ab, bc, c}, {ab, b, bc}};
}

/// The mean of the three.
double mean_of(const std::array<double, 3>& x) { return (x[0] + x[1] + x[2]) / 3.0; }

}  // namespace

void LooseSheets::add(const LooseSheets& other) {
    const auto first = static_cast<std::uint32_t>(position.size());
    position.insert(position.end(), other.position.begin(), other.position.end());
    velocity.insert(velocity.end(), other.velocity.begin(), other.velocity.end());
    circulation.insert(circulation.end(), other.circulation.begin(), other.circulation.end());
    for (const Triangle& t : other.triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    most += other.most;
}

LooseSheets LooseSheets::ahead(double dt) const {
    LooseSheets moved = *this;
    for (std::size_t v = 0; v < position.size(); ++v) moved.position[v] += dt * velocity[v];
    return moved;
}

std::vector<Vec3> LooseSheets::barycenters() const {
    std::vector<Vec3> center;
    for (const Triangle& t : triangles) center.push_back((position[t[0]] + position[t[1]] + position[t[2]]) / 3.0);
    return center;
}

std::vector<Vec3> LooseSheets::strengths() const {
    std::vector<Vec3> strength;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto& [a, b, c] = triangles[i];
        const auto& jump = circulation[i];
        strength.push_back(-0.5 * ((jump[1] - jump[0]) * (position[a] - position[c]) +
                                   (jump[2] - jump[0]) * (position[b] - position[a])));
    }
    return strength;
}

std::vector<Vec3> LooseSheets::mean_at_vertices(const Vec3* triangle_velocity) const {
    std::vector<Vec3> mean(position.size());
    std::vector<double> weight(position.size(), 0.0);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const double area = norm(area_vector(*this, triangles[i]));
        for (const std::uint32_t v : triangles[i]) {
            mean[v] += area * triangle_velocity[i];
            weight[v] += area;
        }
    }
    for (std::size_t v = 0; v < mean.size(); ++v)
        if (weight[v] > 0.0) mean[v] = mean[v] / weight[v];
    return mean;
}

Vec3 LooseSheets::impulse() const {
    Vec3 sum;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        sum -= mean_of(circulation[i]) * area_vector(*this, triangles[i]);
    return sum;
}

Vec3 LooseSheets::angular_impulse() const {
    Vec3 sum;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const double total = 3.0 * mean_of(circulation[i]);
        Vec3 arm;  // integral of Gamma x over the triangle, over its area, both linear
        for (std::size_t k = 0; k < 3; ++k) arm += ((circulation[i][k] + total) / 12.0) * position[triangles[i][k]];
        sum -= cross(arm, area_vector(*this, triangles[i]));
    }
    return sum;
}

void LooseSheets::refine(double longest) {
    constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::map<Edge, std::uint32_t> middle;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Edge e = edge_of(t, k);
            if (squared_norm(position[e.first] - position[e.second]) > longest * longest) middle[e] = kNone;
        }
    // An edge between two triangles makes two more of them.
    if (middle.empty() || triangles.size() + 2 * middle.size() > most) return;
    for (auto& [e, v] : middle) {
        v = static_cast<std::uint32_t>(position.size());
        position.push_back(0.5 * (position[e.first] + position[e.second]));
        velocity.push_back(0.5 * (velocity[e.first] + velocity[e.second]));
    }
    std::vector<Triangle> parts;
    std::vector<std::array<double, 3>> jumps;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        std::array<std::uint32_t, 6> point{};
        std::array<double, 6> value{};
        std::array<bool, 3> halved{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = middle.find(edge_of(triangles[i], k));
            halved[k] = at != middle.end();
            point[k] = triangles[i][k];
            point[3 + k] = halved[k] ? at->second : kNone;
            value[k] = circulation[i][k];
            value[3 + k] = 0.5 * (circulation[i][k] + circulation[i][(k + 1) % 3]);
        }
        for (const auto& [a, b, c] : parts_of(halved)) {
            parts.push_back({point[a], point[b], point[c]});
            jumps.push_back({value[a], value[b], value[c]});
        }
    }
    triangles = std::move(parts);
    circulation = std::move(jumps);
}

LooseSheets left_behind(const SheetState& before,
                        const IdVector<VertexId, Vec3>& velocity,
                        const mesh::CompactionMaps& maps,
                        const SheetState& after) {
    double largest = 0.0;
    for (const double value : before.phi) largest = std::max(largest, std::abs(value));
    constexpr double kRounding = 1e-12;

    LooseSheets sheets;
    std::map<VertexId, std::uint32_t> number;
    const auto vertex = [&](VertexId v) {
        const auto [at, is_new] = number.try_emplace(v, static_cast<std::uint32_t>(number.size()));
        if (is_new) {
            sheets.position.push_back(before.mesh.position[v]);
            sheets.velocity.push_back(velocity[v]);
        }
        return at->second;
    };
    for (const FaceId f : before.mesh.faces.ids()) {
        const auto& corners = before.mesh.faces[f].vertices;
        std::array<double, 3> change{};
        for (std::size_t k = 0; k < 3; ++k) change[k] = jump(before.topology, before.phi, f, k);
        if (const FaceId now = maps.face[f]; now != mesh::kNoFace) {
            // Edits without motion turn no face around: its regions stay on their sides.
            const auto& there = after.mesh.faces[now].vertices;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto at = std::find(there.begin(), there.end(), maps.vertex[corners[k]]) - there.begin();
                change[k] -= jump(after.topology, after.phi, now, static_cast<std::size_t>(at));
            }
            const auto most = std::max({std::abs(change[0]), std::abs(change[1]), std::abs(change[2])});
            if (most <= kRounding * largest) continue;
        }
        sheets.triangles.push_back({vertex(corners[0]), vertex(corners[1]), vertex(corners[2])});
        sheets.circulation.push_back(change);
    }
    sheets.most = kMostGrowth * sheets.triangles.size();
    return sheets;
}

}  // namespace lamella::vortex_sheet
