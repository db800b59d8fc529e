#include "lamella/render/camera.h"

#include "lamella/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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
    if (!(low[0] <= high[0])) throw InputError("there is nothing to be seen: no films and no points");

    Bounds bounds{0.5 * (low + high), 0.0};
    for (const auto& t : frame.surface.triangles)
        for (const std::uint32_t v : t)
            if (v < frame.surface.position.size())
                bounds.radius = std::max(bounds.radius, norm(frame.surface.position[v] - bounds.center));
    for (std::size_t i = 0; i < frame.points.size(); ++i)
        bounds.radius = std::max(bounds.radius, norm(frame.points.position[i] - bounds.center) + radius(i));
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

Camera::Camera(const View& view, const Bounds& bounds, std::size_t width, std::size_t height) {
    const double az = view.azimuth_deg * std::numbers::pi / 180.0, el = view.elevation_deg * std::numbers::pi / 180.0;
    const Vec3 back{{std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)}};
    const Vec3 right{{-std::sin(az), std::cos(az), 0.0}};
    const Vec3 up = cross(back, right);
    const double half_angle = 0.5 * view.field_of_view_deg * std::numbers::pi / 180.0;
    constexpr double kMargin = 1.06;
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
