#include "lamella/mesh/shapes/sphere.h"

#include "lamella/core/error.h"
#include "lamella/mesh/shapes/detail/builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::mesh {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Icosahedron {
    std::vector<Vec3> corner;
    std::vector<std::array<std::size_t, 3>> face;  // counterclockwise seen from outside
};

Icosahedron icosahedron() {
    const double t = 0.5 * (1.0 + std::sqrt(5.0));
    Icosahedron solid;
    for (const double s : {-1.0, 1.0})
        for (const double q : {-t, t}) {
            solid.corner.push_back({{0.0, s, q}});
            solid.corner.push_back({{s, q, 0.0}});
            solid.corner.push_back({{q, 0.0, s}});
        }
    // Its faces are the triples of corners at distance 2.
    const auto near = [&](std::size_t a, std::size_t b) {
        return std::abs(norm(solid.corner[a] - solid.corner[b]) - 2.0) < 1e-6;
    };
    for (std::size_t a = 0; a < 12; ++a)
        for (std::size_t b = a + 1; b < 12; ++b)
            for (std::size_t c = b + 1; c < 12; ++c) {
                if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
                const bool outward = dot(solid.corner[a], cross(solid.corner[b], solid.corner[c])) > 0.0;
                solid.face.push_back({a, outward ? b : c, outward ? c : b});
            }
    return solid;
}

void add_sphere(FoamMesh& mesh, const Ball& ball, double edge_length, RegionId inside) {
    // 20 n^2 equilateral triangles with the sphere's area have edges of 1.2046 R / n.
    const int n = std::max(1, static_cast<int>(std::lround(1.2046 * ball.radius / edge_length)));
    const Icosahedron solid = icosahedron();
    detail::Welder weld(mesh, ball.radius);
    for (const auto& [a, b, c] : solid.face) {
        const auto vertex = [&, a = a, b = b, c = c](double u, double v) {
            const Vec3 flat = (1.0 - u - v) * solid.corner[a] + u * solid.corner[b] + v * solid.corner[c];
            return weld.at(ball.center + (ball.radius / norm(flat)) * flat);
        };
        detail::add_triangle_grid(mesh, n, vertex, inside, kOutside);
    }
}

}  // namespace

FoamMesh spheres(const std::vector<Ball>& balls, double edge_length) {
    if (balls.empty()) throw InputError("at least one ball is needed");
    detail::require_positive(edge_length, "edge length");
    double area = 0.0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        detail::require_positive(balls[i].radius, "radius of a ball");
        area += 4.0 * kPi * balls[i].radius * balls[i].radius;
        for (std::size_t j = 0; j < i; ++j)
            if (norm(balls[i].center - balls[j].center) <= balls[i].radius + balls[j].radius)
                throw InputError(fmt::format("balls {} and {} touch; separate spheres must not", j + 1, i + 1));
    }
    detail::require_affordable(area, edge_length);
    FoamMesh mesh = detail::empty_mesh(balls.size(), RegionKind::kClosed);
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const auto region = static_cast<RegionId>(i + 1);
        mesh.regions[region].target_volume = 4.0 / 3.0 * kPi * std::pow(balls[i].radius, 3);
        add_sphere(mesh, balls[i], edge_length, region);
    }
    return mesh;
}

}  // namespace lamella::mesh
