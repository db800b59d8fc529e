#include "lamella/render/camera.h"

#include "lamella/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace lamella::render {

Bounds frame_bounds(const sim::Frame& frame) {
    const auto radius = [&](std::size_t i) { return i < frame.points.radius.size() ? frame.points.radius[i] : 0.0; };
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Vec3 low{{kFar, kFar, kFar}}, high = -low;
    const auto include = [&](const Vec3& p, double r) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k] - r);
            high[k] = std::max(high[k], p[k] + r);
        }
    };
    for (const auto& t : frame.surface.triangles)
        for (const std::uint32_t v : t)
            if (v < frame.surface.position.size()) include(frame.surface.position[v], 0.0);
    for (std::size_t i = 0; i < frame.points.size(); ++i) include(frame.points.position[i], radius(i));
    for (const sim::Solid& solid : frame.solids) include(solid.center, solid.radius);
    if (!(low[0] <= high[0])) throw InputError("there is nothing to be seen: no films and no points");

    Bounds bounds{0.5 * (low + high), 0.0};
    for (const auto& t : frame.surface.triangles)
        for (const std::uint32_t v : t)
            if (v < frame.surface.position.size())
                bounds.radius = std::max(bounds.radius, norm(frame.surface.position[v] - bounds.center));
    for (std::size_t i = 0; i < frame.points.size(); ++i)
        bounds.radius = std::max(bounds.radius, norm(frame.points.position[i] - bounds.center) + radius(i));
    for (const sim::Solid& solid : frame.solids)
        bounds.radius = std::max(bounds.radius, norm(solid.center - bounds.center) + solid.radius);
    if (!(bounds.radius > 0.0) || !std::isfinite(bounds.radius))
        throw InputError("all that could be seen lies in one point, or nowhere");
    return bounds;
}

Bounds joined(const Bounds& a, const Bounds& b) {
    const Vec3 apart = b.center - a.center;
    const double distance = norm(apart);
    if (distance + b.radius <= a.radius) return a;
    if (distance + a.radius <= b.radius) return b;
    const double radius = 0.5 * (distance + a.radius + b.radius);
    return {a.center + (radius - a.radius) / distance * apart, radius};
}

namespace {

/// The normal of films that all lie in one plane; none for others.
std::optional<Vec3> common_normal(const sim::Surface& s) {
    Vec3 sum;
    double area = 0.0;
    for (const auto& t : s.triangles) {
        if (*std::max_element(t.begin(), t.end()) >= s.position.size()) return std::nullopt;
        const Vec3 own = cross(s.position[t[1]] - s.position[t[0]], s.position[t[2]] - s.position[t[0]]);
        sum += dot(own, sum) < 0.0 ? -own : own;
        area += norm(own);
    }
    constexpr double kFlat = 0.999;  // films that bulge by less than three degrees
    if (!(area > 0.0) || norm(sum) < kFlat * area) return std::nullopt;
    return sum / norm(sum);
}

constexpr double kMargin = 1.06;  // around the ball that holds everything

/// The zoom with which everything just fits the part of a picture that is free, seen from where `view` stands: not its
/// ball, as that of a film in a plane is mostly empty.
double filling_zoom(const sim::Frame& frame, const View& view, const Vec2& room) {
    const Bounds bounds = frame_bounds(frame);
    const double az = view.azimuth_deg * std::numbers::pi / 180.0, el = view.elevation_deg * std::numbers::pi / 180.0;
    const Vec3 back{{std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)}};
    const Vec3 right{{-std::sin(az), std::cos(az), 0.0}};
    const Vec3 up = cross(back, right);
    const double half_angle = 0.5 * view.field_of_view_deg * std::numbers::pi / 180.0;
    constexpr double kFilled = 0.94;
    double distance = 0.0;  // of the camera from the middle
    const auto include = [&](const Vec3& p, double r) {
        const Vec3 arm = p - bounds.center;
        const double off = std::max((std::abs(dot(arm, right)) + r) / room[0], (std::abs(dot(arm, up)) + r) / room[1]);
        distance = std::max(distance, dot(arm, back) + off / (kFilled * std::tan(half_angle)));
    };
    for (const auto& t : frame.surface.triangles)
        for (const std::uint32_t v : t) include(frame.surface.position[v], 0.0);
    for (std::size_t i = 0; i < frame.points.radius.size(); ++i)
        include(frame.points.position[i], frame.points.radius[i]);
    for (const sim::Solid& solid : frame.solids) include(solid.center, solid.radius);
    return kMargin * bounds.radius / (std::sin(half_angle) * distance);
}

/// From where a film that stands upright in a plane is seen: a little from the side, and from below, so that it mirrors
/// lamps and not the floor.
View before_upright_film(const Vec3& normal) {
    View view;
    constexpr double kDegrees = 180.0 / std::numbers::pi, kOblique = 40.0;
    const double toward = std::atan2(normal[1], normal[0]) * kDegrees;
    const double turned = std::remainder(toward - view.azimuth_deg, 180.0);  // from the usual place to before the film
    if (std::abs(turned) > kOblique) view.azimuth_deg += turned - std::copysign(kOblique, turned);
    view.elevation_deg = -20.0;
    return view;
}

}  // namespace

View usual_view(const sim::Frame& frame, const Vec2& room) {
    View view;
    view.zoom = std::min({1.0, room[0], room[1]});
    if (frame.box && frame.box->dimension == 2) {
        view = {.azimuth_deg = -90.0, .elevation_deg = 90.0};
        if (!frame.surface.empty() || !frame.points.empty()) view.zoom = filling_zoom(frame, view, room);
        return view;
    }
    if (!frame.points.radius.empty()) return view;
    const std::optional<Vec3> normal = common_normal(frame.surface);
    if (!normal) return view;
    constexpr double kLies = 0.7;
    // A film that lies: y goes up in the picture, and the film mirrors what is above.
    if (std::abs((*normal)[2]) > kLies)
        view.azimuth_deg = -90.0, view.elevation_deg = 58.0;
    else
        view = before_upright_film(*normal);
    view.zoom = filling_zoom(frame, view, room);
    return view;
}

Camera::Camera(const View& view, const Bounds& bounds, std::size_t width, std::size_t height) {
    const double az = view.azimuth_deg * std::numbers::pi / 180.0, el = view.elevation_deg * std::numbers::pi / 180.0;
    const Vec3 back{{std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)}};
    const Vec3 right{{-std::sin(az), std::cos(az), 0.0}};
    const Vec3 up = cross(back, right);
    const double half_angle = 0.5 * view.field_of_view_deg * std::numbers::pi / 180.0;
    position_ = bounds.center + kMargin * bounds.radius / (std::sin(half_angle) * view.zoom) * back;
    const double shorter = static_cast<double>(std::min(width, height));
    const double pixel = 2.0 * std::tan(half_angle) / shorter;
    across_ = pixel * right;
    down_ = -pixel * up;
    corner_ =
        -back - (0.5 - view.shift) * static_cast<double>(width) * across_ - 0.5 * static_cast<double>(height) * down_;
}

Vec3 Camera::direction(double x, double y) const {
    const Vec3 d = corner_ + x * across_ + y * down_;
    return d / norm(d);
}

}  // namespace lamella::render
