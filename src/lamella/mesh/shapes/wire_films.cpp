#include "lamella/mesh/shapes/wire_films.h"

#include "lamella/core/error.h"
#include "lamella/mesh/shapes/detail/builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lamella::mesh {
namespace {

using detail::Axis;
using detail::Revolution;

constexpr double kPi = 3.14159265358979323846;
constexpr RegionId kInside{1};

FoamMesh empty_film() { return detail::empty_mesh(1, RegionKind::kOpen); }

int pieces(double length, double edge_length) {
    return std::max(1, static_cast<int>(std::lround(length / edge_length)));
}

/// Edges and, by the corners around it, faces of a regular frame of edge length 1 around the origin.
struct Frame {
    std::vector<Vec3> corner;
    std::vector<Vec3> face;  // its center
};

Frame regular_frame(FrameShape shape) {
    switch (shape) {
        case FrameShape::kTetrahedron: {
            const double s = 1.0 / std::sqrt(8.0);
            Frame frame{{{{s, s, s}}, {{s, -s, -s}}, {{-s, s, -s}}, {{-s, -s, s}}}, {}};
            for (const Vec3& c : frame.corner) frame.face.push_back((-1.0 / 3.0) * c);
            return frame;
        }
        case FrameShape::kCube: {
            Frame frame;
            for (const double x : {-0.5, 0.5})
                for (const double y : {-0.5, 0.5})
                    for (const double z : {-0.5, 0.5}) frame.corner.push_back({{x, y, z}});
            for (std::size_t k = 0; k < 3; ++k)
                for (const double s : {-0.5, 0.5}) {
                    Vec3 center;
                    center[k] = s;
                    frame.face.push_back(center);
                }
            return frame;
        }
        case FrameShape::kOctahedron: {
            Frame frame;
            for (std::size_t k = 0; k < 3; ++k)
                for (const double s : {-std::sqrt(0.5), std::sqrt(0.5)}) {
                    Vec3 corner;
                    corner[k] = s;
                    frame.corner.push_back(corner);
                }
            const double third = std::sqrt(0.5) / 3.0;
            for (const double x : {-third, third})
                for (const double y : {-third, third})
                    for (const double z : {-third, third}) frame.face.push_back({{x, y, z}});
            return frame;
        }
    }
    return {};
}

}  // namespace

FoamMesh disk(const Vec3& center, const Vec3& normal, double radius, double edge_length) {
    detail::require_positive(radius, "radius of the disk");
    detail::require_positive(edge_length, "edge length");
    detail::require_affordable(kPi * radius * radius, edge_length);
    FoamMesh mesh = empty_film();
    Revolution film(mesh, Axis(center, normal), edge_length, kInside, kOutside);
    film.close(film.ring(radius, 0.0, true), radius,
               [=](double s) { return std::array<double, 2>{radius * (1.0 - s), 0.0}; });
    return mesh;
}

namespace {

/// Even steps from 0 to 1.
std::vector<double> even_ticks(int count) {
    std::vector<double> ticks;
    for (int i = 0; i <= count; ++i) ticks.push_back(static_cast<double>(i) / count);
    return ticks;
}

/// Steps from 0 to 1 of a side of `length`, shorter around `center`: as many as there are edges along it, where the
/// edge at x is h(x), each end at a whole number of the integral of 1/h.
std::vector<double> graded_ticks(double length, double center, double edge_length, const Focus& focus) {
    constexpr double kGrowth = 0.1;
    constexpr int kSamples = 20'000;
    const auto edges_until = [&](int sample) {
        const double away = std::max(0.0, std::abs(length * (sample + 0.5) / kSamples - center) - focus.radius);
        return length / kSamples / std::min(edge_length, focus.edge_length + kGrowth * away);
    };
    double total = 0.0;
    for (int k = 0; k < kSamples; ++k) total += edges_until(k);
    if (!(total < kSamples / 4))
        throw InputError(fmt::format("edges of {} m around the focus are too short for a side of {} m", focus.edge_length, length));
    const int count = std::max(1, static_cast<int>(std::lround(total)));
    std::vector<double> ticks{0.0};
    double sum = 0.0;
    for (int k = 0; k < kSamples && static_cast<int>(ticks.size()) < count; ++k) {
        const double next = sum + edges_until(k) * count / total;
        const auto wanted = static_cast<double>(ticks.size());
        if (next >= wanted) ticks.push_back((k + (wanted - sum) / (next - sum)) / kSamples);
        sum = next;
    }
    ticks.push_back(1.0);
    return ticks;
}

void require_right_angle(const Vec3& u, const Vec3& v, double edge_length) {
    detail::require_positive(edge_length, "edge length");
    detail::require_positive(norm(cross(u, v)), "area of the rectangle");
    if (std::abs(dot(u, v)) > 1e-9 * norm(u) * norm(v))
        throw InputError("the sides of a rectangle must be at right angles");
}

/// Two triangles between any two neighbors of each row of ticks, their diagonals in turn.
FoamMesh net(const Vec3& origin, const Vec3& u, const Vec3& v, const std::vector<double>& along_u, const std::vector<double>& along_v) {
    FoamMesh mesh = empty_film();
    const int nu = static_cast<int>(along_u.size()) - 1, nv = static_cast<int>(along_v.size()) - 1;
    const auto at = [&](int i, int j) { return static_cast<VertexId>(j * (nu + 1) + i); };
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i)
            mesh.add_vertex(origin + along_u[static_cast<std::size_t>(i)] * u + along_v[static_cast<std::size_t>(j)] * v,
                            i == 0 || i == nu || j == 0 || j == nv);
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const VertexId a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if ((i + j) % 2 == 0) {
                mesh.add_face(a, b, c, kInside, kOutside);
                mesh.add_face(a, c, d, kInside, kOutside);
            } else {
                mesh.add_face(a, b, d, kInside, kOutside);
                mesh.add_face(b, c, d, kInside, kOutside);
            }
        }
    return mesh;
}

}  // namespace

FoamMesh rectangle(const Vec3& origin, const Vec3& u, const Vec3& v, double edge_length) {
    require_right_angle(u, v, edge_length);
    detail::require_affordable(norm(cross(u, v)), edge_length);
    return net(origin, u, v, even_ticks(pieces(norm(u), edge_length)), even_ticks(pieces(norm(v), edge_length)));
}

FoamMesh rectangle(const Vec3& origin, const Vec3& u, const Vec3& v, double edge_length, const Focus& focus) {
    require_right_angle(u, v, edge_length);
    detail::require_positive(focus.edge_length, "edge length of the focus");
    detail::require_affordable(norm(cross(u, v)), edge_length);
    const auto ticks = [&](const Vec3& side) {
        const double length = norm(side);
        return graded_ticks(length, dot(focus.center - origin, side) / length, edge_length, focus);
    };
    const std::vector<double> along_u = ticks(u), along_v = ticks(v);
    detail::require_affordable(static_cast<double>(along_u.size() * along_v.size()), 1.0);
    return net(origin, u, v, along_u, along_v);
}

namespace {

/// Closes the half of a sphere on its rim, upwards or downwards.
void close_dome(Revolution& film, const std::vector<VertexId>& rim, double radius, double up) {
    film.close(rim, 0.5 * kPi * radius, [=](double s) {
        const double angle = 0.5 * kPi * s;
        return std::array<double, 2>{s < 1.0 ? radius * std::cos(angle) : 0.0, up * radius * std::sin(angle)};
    });
}

void require_dome(double radius, double edge_length) {
    detail::require_positive(radius, "radius of the hemisphere");
    detail::require_positive(edge_length, "edge length");
    detail::require_affordable(4.0 * kPi * radius * radius, edge_length);
}

}  // namespace

FoamMesh hemisphere(const Vec3& center, const Vec3& axis, double radius, double edge_length) {
    require_dome(radius, edge_length);
    FoamMesh mesh = empty_film();
    Revolution film(mesh, Axis(center, axis), edge_length, kInside, kOutside);
    close_dome(film, film.ring(radius, 0.0, true), radius, 1.0);
    return mesh;
}

FoamMesh ball_in_ring(const Vec3& center, const Vec3& axis, double radius, double edge_length) {
    constexpr RegionId kBelow{2};
    require_dome(radius, edge_length);
    FoamMesh mesh = detail::empty_mesh(2, RegionKind::kOpen);
    mesh.regions[kInside] = {RegionKind::kClosed, 4.0 / 3.0 * kPi * radius * radius * radius};
    Revolution upper(mesh, Axis(center, axis), edge_length, kInside, kOutside);
    const auto rim = upper.ring(radius, 0.0, true);
    close_dome(upper, rim, radius, 1.0);
    // Seen from the same side its faces turn the other way.
    Revolution lower(mesh, Axis(center, axis), edge_length, kBelow, kInside);
    close_dome(lower, rim, radius, -1.0);
    return mesh;
}

FoamMesh cylinder(const Vec3& center, const Vec3& axis, double radius, double separation, double edge_length) {
    detail::require_positive(radius, "radius of the cylinder");
    detail::require_positive(separation, "separation of the rings");
    detail::require_positive(edge_length, "edge length");
    detail::require_affordable(2.0 * kPi * radius * separation, edge_length);
    FoamMesh mesh = empty_film();
    Revolution film(mesh, Axis(center, axis), edge_length, kInside, kOutside);
    const auto bottom = film.ring(radius, -0.5 * separation, true), top = film.ring(radius, 0.5 * separation, true);
    film.join(bottom, top, separation,
              [=](double s) { return std::array<double, 2>{radius, separation * (s - 0.5)}; });
    return mesh;
}

double catenoid_neck(double radius, double separation, CatenoidBranch branch) {
    detail::require_positive(radius, "radius of the rings");
    detail::require_positive(separation, "separation of the rings");
    // With t = separation / (2 neck): cosh(t) / t = 2 radius / separation, least where t tanh(t) = 1.
    constexpr double kCritical = 1.1996786402577339;
    const double wanted = 2.0 * radius / separation;
    if (wanted < std::cosh(kCritical) / kCritical)
        throw InputError(fmt::format("rings of radius {} hold no catenoid at a separation of {}: at most {:.7g}", radius,
                                     separation, 1.3254868387 * radius));
    double near = kCritical, far = branch == CatenoidBranch::kStable ? 1e-300 : 700.0;
    for (int k = 0; k < 2000; ++k) {
        const double middle = 0.5 * (near + far);
        if (middle == near || middle == far) break;
        (std::cosh(middle) < wanted * middle ? near : far) = middle;
    }
    return 0.5 * separation / near;
}

FoamMesh catenoid(const Vec3& center,
                  const Vec3& axis,
                  double radius,
                  double separation,
                  double edge_length,
                  CatenoidBranch branch) {
    detail::require_positive(edge_length, "edge length");
    const double neck = catenoid_neck(radius, separation, branch);
    const double steep = 0.5 * separation / neck;
    const double length = 2.0 * neck * std::sinh(steep);
    detail::require_affordable(2.0 * kPi * radius * length, edge_length);
    FoamMesh mesh = empty_film();
    Revolution film(mesh, Axis(center, axis), edge_length, kInside, kOutside);
    const auto bottom = film.ring(radius, -0.5 * separation, true), top = film.ring(radius, 0.5 * separation, true);
    film.join(bottom, top, length, [=](double s) {  // s goes with the arc length: z = neck asinh(arc / neck)
        const double z = neck * std::asinh((2.0 * s - 1.0) * std::sinh(steep));
        return std::array<double, 2>{neck * std::cosh(z / neck), z};
    });
    return mesh;
}

FoamMesh frame_cone(FrameShape shape, const Vec3& center, double frame_edge, double edge_length) {
    detail::require_positive(frame_edge, "edge of the frame");
    detail::require_positive(edge_length, "edge length");
    const Frame frame = regular_frame(shape);
    detail::require_affordable(12.0 * frame_edge * frame_edge, edge_length);
    FoamMesh mesh = detail::empty_mesh(frame.face.size(), RegionKind::kOpen);
    detail::Welder weld(mesh, frame_edge);
    const int n = pieces(frame_edge, edge_length);
    for (std::size_t a = 0; a < frame.corner.size(); ++a)
        for (std::size_t b = a + 1; b < frame.corner.size(); ++b) {
            const Vec3 p = frame.corner[a], q = frame.corner[b];
            if (std::abs(norm(p - q) - 1.0) > 1e-9) continue;
            // The two faces of the frame at this edge are those nearest to its middle, one on either side of the film.
            RegionId back{}, front{};
            std::vector<std::pair<double, std::size_t>> near;
            for (std::size_t f = 0; f < frame.face.size(); ++f)
                near.emplace_back(norm(frame.face[f] - 0.5 * (p + q)), f);
            std::sort(near.begin(), near.end());
            for (std::size_t k = 0; k < 2; ++k) {
                const bool ahead = dot(cross(p, q), frame.face[near[k].second]) > 0.0;
                (ahead ? front : back) = static_cast<RegionId>(near[k].second + 1);
            }
            const auto vertex = [&](double u, double v) {
                return weld.at(center + frame_edge * (u * p + v * q), u + v > 1.0 - 0.5 / n);
            };
            detail::add_triangle_grid(mesh, n, vertex, back, front);
        }
    return mesh;
}

}  // namespace lamella::mesh
