#include "lamella/solvers/melp/bubble_shapes.h"

#include "lamella/mesh/volume.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace lamella::melp {

using mesh::Ball;
using mesh::FaceId;
using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;
using mesh::VertexId;

RegionSurface surface_of(const FoamMesh& mesh, RegionId region) {
    RegionSurface surface;
    IdVector<VertexId, Vec3> around(mesh.position.size());
    for (const FaceId f : mesh.faces.ids()) {
        const mesh::Face& face = mesh.faces[f];
        if (face.back != region && face.front != region) continue;
        std::array<Vec3, 3> corner{mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)};
        if (face.front == region) std::swap(corner[1], corner[2]);
        const Vec3 area = 0.5 * cross(corner[1] - corner[0], corner[2] - corner[0]);
        for (const VertexId v : face.vertices) around[v] += area;
        surface.area += norm(area);
        surface.triangle.push_back(corner);
    }
    for (const VertexId v : around.ids())
        if (squared_norm(around[v]) > 0.0) {
            surface.vertex.push_back(mesh.position[v]);
            surface.normal.push_back(around[v] / norm(around[v]));
        }
    return surface;
}

std::optional<Ball> ball_of(const RegionSurface& surface) {
    Ball ball{};
    for (const Vec3& x : surface.vertex) ball.center += x / static_cast<double>(surface.vertex.size());
    for (const Vec3& x : surface.vertex)
        ball.radius += norm(x - ball.center) / static_cast<double>(surface.vertex.size());
    constexpr double kRound = 1e-6;
    for (const Vec3& x : surface.vertex)
        if (std::abs(norm(x - ball.center) - ball.radius) > kRound * ball.radius) return std::nullopt;
    return ball;
}

namespace {

/// Regions of the mesh that share films, by their smallest.
IdVector<RegionId, RegionId> clusters_of(const FoamMesh& mesh) {
    IdVector<RegionId, RegionId> cluster(mesh.regions.size());
    for (const RegionId r : mesh.regions.ids()) cluster[r] = r;
    const auto root = [&](RegionId r) {
        while (cluster[r] != r) r = cluster[r];
        return r;
    };
    for (const mesh::Face& face : mesh.faces) {
        if (face.back == mesh::kOutside || face.front == mesh::kOutside) continue;
        const RegionId a = root(face.back), b = root(face.front);
        cluster[std::max(a, b)] = std::min(a, b);
    }
    for (const RegionId r : mesh.regions.ids()) cluster[r] = root(r);
    return cluster;
}

/// Moves balls apart that are nearer to each other than a hundredth of their radii, each pair along its line.
void move_apart(std::vector<Ball>& balls) {
    constexpr double kGap = 1.01;
    constexpr int kMostPasses = 2000;
    bool moved = true;
    for (int pass = 0; pass < kMostPasses && moved; ++pass) {
        moved = false;
        for (std::size_t i = 0; i < balls.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const Vec3 d = balls[i].center - balls[j].center;
                const double distance = norm(d), least = kGap * (balls[i].radius + balls[j].radius);
                if (distance >= least) continue;
                constexpr double kMore = 1.001;  // else the last pairs would never be done
                const Vec3 unit = distance > 0.0 ? d / distance : Vec3{{1.0, 0.0, 0.0}};
                const Vec3 half = (0.5 * (kMore * least - distance)) * unit;
                balls[i].center += half;
                balls[j].center -= half;
                moved = true;
            }
    }
}

}  // namespace

IdVector<RegionId, std::optional<Ball>> loose_balls(const FoamMesh& mesh) {
    constexpr double kFarthest = 0.1;
    const IdVector<RegionId, double> volume = mesh::region_volumes(mesh);
    const IdVector<RegionId, RegionId> cluster = clusters_of(mesh);
    IdVector<RegionId, std::uint8_t> loose(mesh.regions.size());
    const auto has_films = [&](RegionId r) { return mesh.regions[r].kind == RegionKind::kClosed && volume[r] > 0.0; };
    for (const RegionId r : mesh.regions.ids())
        if (has_films(r) && std::abs(volume[r] / mesh.regions[r].target_volume - 1.0) > kFarthest)
            loose[cluster[r]] = 1;
    IdVector<RegionId, std::optional<Ball>> result(mesh.regions.size());
    if (std::none_of(loose.begin(), loose.end(), [](std::uint8_t l) { return l != 0; })) return result;
    std::vector<Ball> balls;
    std::vector<RegionId> region;
    for (const RegionId r : mesh.regions.ids()) {
        if (!has_films(r)) continue;
        const RegionSurface surface = surface_of(mesh, r);
        Vec3 center;
        for (const Vec3& x : surface.vertex) center += x / static_cast<double>(surface.vertex.size());
        balls.push_back({center, std::cbrt(0.75 * mesh.regions[r].target_volume / std::numbers::pi)});
        region.push_back(r);
    }
    move_apart(balls);
    for (std::size_t k = 0; k < balls.size(); ++k)
        if (loose[cluster[region[k]]] != 0) result[region[k]] = balls[k];
    return result;
}

}  // namespace lamella::melp
