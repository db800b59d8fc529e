#include "lamella/mesh/shapes/standard_clusters.h"

#include "lamella/mesh/shapes/detail/builder.h"
#include "lamella/mesh/shapes/power_cluster.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella::mesh {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Ball of radius R without what lies beyond a plane at distance `to_plane` from its center.
double segment_volume(double radius, double to_plane) {
    const double height = radius + to_plane;
    return kPi * height * height * (3.0 * radius - height) / 3.0;
}

/// How far the partition bulges toward bubble 1.
double partition_height(const DoubleBubble& b) {
    const double k = b.partition_curvature, rho = b.circle_radius;
    return rho * rho * k / (1.0 + std::sqrt(std::max(0.0, 1.0 - rho * rho * k * k)));
}

/// Distance from the center of the cap with radius `own` to the plane of the triple line, positive inward.
double plane_distance(double own, double other, double center_distance) {
    return own * (2.0 * own - other) / (2.0 * center_distance);
}

FoamMesh cluster_of_touching_balls(const std::vector<Vec3>& directions, double volume, double edge_length) {
    detail::require_positive(volume, "volume");
    detail::require_positive(edge_length, "edge length");
    const double radius = std::cbrt(0.75 * volume / kPi);
    const double between = norm(directions[0] - directions[1]);
    std::vector<Ball> balls;
    for (const Vec3& d : directions) balls.push_back({(1.8 * radius / between) * d, radius});
    FoamMesh mesh = power_cluster(balls, edge_length);
    for (const RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == RegionKind::kClosed) mesh.regions[r].target_volume = volume;
    return mesh;
}

}  // namespace

DoubleBubble double_bubble_of_radii(double radius1, double radius2) {
    detail::require_positive(radius1, "radius of bubble 1");
    detail::require_positive(radius2, "radius of bubble 2");
    DoubleBubble b;
    b.radius1 = radius1;
    b.radius2 = radius2;
    b.partition_curvature = 1.0 / radius2 - 1.0 / radius1;
    // The three films meet at 120 degrees: the radii drawn to the triple line enclose 60.
    b.center_distance = std::sqrt(radius1 * radius1 + radius2 * radius2 - radius1 * radius2);
    b.circle_radius = 0.5 * std::sqrt(3.0) * radius1 * radius2 / b.center_distance;
    const double plane1 = plane_distance(radius1, radius2, b.center_distance);
    const double plane2 = plane_distance(radius2, radius1, b.center_distance);
    const double bulge = partition_height(b), rho = b.circle_radius;
    b.area1 = 2.0 * kPi * radius1 * (radius1 + plane1);
    b.area2 = 2.0 * kPi * radius2 * (radius2 + plane2);
    b.partition_area = kPi * (rho * rho + bulge * bulge);
    const double lens = kPi * bulge * (3.0 * rho * rho + bulge * bulge) / 6.0;
    b.volume1 = segment_volume(radius1, plane1) - lens;
    b.volume2 = segment_volume(radius2, plane2) + lens;
    return b;
}

DoubleBubble double_bubble_of_volumes(double volume1, double volume2) {
    detail::require_positive(volume1, "volume of bubble 1");
    detail::require_positive(volume2, "volume of bubble 2");
    const bool swapped = volume2 > volume1;
    const double wanted = swapped ? volume1 / volume2 : volume2 / volume1;
    // The ratio of the volumes grows with that of the radii; the smaller cap's radius stays above cbrt(wanted) / 2.
    double low = 0.25 * std::cbrt(wanted), high = 1.0;
    for (int k = 0; k < 200 && low < high; ++k) {
        const double middle = 0.5 * (low + high);
        if (middle == low || middle == high) break;
        const DoubleBubble b = double_bubble_of_radii(1.0, middle);
        (b.volume2 < wanted * b.volume1 ? low : high) = middle;
    }
    const double scale = std::cbrt(std::max(volume1, volume2) / double_bubble_of_radii(1.0, high).volume1);
    return swapped ? double_bubble_of_radii(high * scale, scale) : double_bubble_of_radii(scale, high * scale);
}

FoamMesh double_bubble(const DoubleBubble& b, double edge_length) {
    detail::require_positive(edge_length, "edge length");
    detail::require_affordable(b.area(), edge_length);
    FoamMesh mesh = detail::empty_mesh(2, RegionKind::kClosed);
    constexpr RegionId kFirst{1}, kSecond{2};
    mesh.regions[kFirst].target_volume = b.volume1;
    mesh.regions[kSecond].target_volume = b.volume2;

    const detail::Axis right({}, {{1.0, 0.0, 0.0}}), left({}, {{-1.0, 0.0, 0.0}});
    detail::Revolution second(mesh, right, edge_length, kSecond, kOutside);
    const std::vector<VertexId> circle = second.ring(b.circle_radius, 0.0, false);
    const std::vector<VertexId> from_left(circle.rbegin(), circle.rend());

    // A cap that starts at the circle and ends at its pole; heights along its own axis.
    const auto add_cap = [&](detail::Revolution& film, const std::vector<VertexId>& ring, double radius, double center) {
        const double opening = std::atan2(b.circle_radius, -center);
        film.close(ring, radius * opening, [=](double s) {
            const double angle = opening * (1.0 - s);
            return std::array<double, 2>{s < 1.0 ? radius * std::sin(angle) : 0.0, center + radius * std::cos(angle)};
        });
    };
    add_cap(second, circle, b.radius2, plane_distance(b.radius2, b.radius1, b.center_distance));
    detail::Revolution first(mesh, left, edge_length, kFirst, kOutside);
    add_cap(first, from_left, b.radius1, plane_distance(b.radius1, b.radius2, b.center_distance));

    detail::Revolution partition(mesh, left, edge_length, kSecond, kFirst);
    const double bulge = partition_height(b), rho = b.circle_radius, k = b.partition_curvature;
    partition.close(from_left, std::hypot(rho, bulge), [=](double s) {
        const double r = rho * (1.0 - s);
        // Height of the sphere of curvature k above the circle's plane.
        const double drop = r * r * k / (1.0 + std::sqrt(std::max(0.0, 1.0 - r * r * k * k)));
        return std::array<double, 2>{r, bulge - drop};
    });
    return mesh;
}

FoamMesh triple_bubble(double volume, double edge_length) {
    std::vector<Vec3> corners;
    for (int k = 0; k < 3; ++k) corners.push_back({{std::cos(2.0 * kPi * k / 3.0), std::sin(2.0 * kPi * k / 3.0), 0.0}});
    return cluster_of_touching_balls(corners, volume, edge_length);
}

FoamMesh quadruple_bubble(double volume, double edge_length) {
    return cluster_of_touching_balls(
        {{{1.0, 1.0, 1.0}}, {{1.0, -1.0, -1.0}}, {{-1.0, 1.0, -1.0}}, {{-1.0, -1.0, 1.0}}}, volume, edge_length);
}

}  // namespace lamella::mesh
