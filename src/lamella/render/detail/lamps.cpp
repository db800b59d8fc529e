#include "lamella/render/detail/lamps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::render::detail {

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

Lamp::Lamp(const LampPlan& plan) : plan_(plan) {
    const double az = plan.azimuth_deg * std::numbers::pi / 180.0, el = plan.elevation_deg * std::numbers::pi / 180.0;
    middle_ = {{std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)}};
    right_ = {{-std::sin(az), std::cos(az), 0.0}};
    up_ = cross(middle_, right_);
    const double corner = std::hypot(plan.half_width + plan.softness, plan.half_height + plan.softness);
    reach_ = 1.0 / std::sqrt(1.0 + corner * corner);
}

optics::Rgb Lamp::light(const Vec3& direction) const {
    const double depth = dot(direction, middle_);
    if (depth <= reach_) return {};
    const double x = dot(direction, right_) / depth, y = dot(direction, up_) / depth;
    // Signed distance from the edge of a rectangle with round corners.
    const double dx = std::abs(x) - plan_.half_width + plan_.roundness,
                 dy = std::abs(y) - plan_.half_height + plan_.roundness;
    const double outside = dx > 0.0 && dy > 0.0 ? std::sqrt(dx * dx + dy * dy) : std::max(dx, dy);
    const double distance = outside - plan_.roundness;
    if (distance >= 0.5 * plan_.softness) return {};
    const double cover = 1.0 - smooth_step(-0.5 * plan_.softness, 0.5 * plan_.softness, distance);
    const double across = x / plan_.half_width, down = y / plan_.half_height;
    constexpr double kFalloff = 0.22;  // how much darker a lamp is in its corners
    return cover * behind_bars(x, y) * (1.0 - kFalloff * (across * across + down * down)) * plan_.light;
}

/// 1 in a pane, 0 on a bar between two panes.
double Lamp::behind_bars(double x, double y) const {
    constexpr double kBar = 0.045;  // half its width, relative to a lamp's half width
    const auto bars = [&](double place, double half, int panes) {
        if (panes < 2) return 1.0;
        const double pane = 2.0 * half / panes;
        const double nearest = std::clamp(std::round((place + half) / pane), 1.0, panes - 1.0);
        const double bar = kBar * plan_.half_width;
        return smooth_step(0.7 * bar, 1.3 * bar, std::abs(place + half - nearest * pane));
    };
    return bars(x, plan_.half_width, plan_.panes_across) * bars(y, plan_.half_height, plan_.panes_down);
}

}  // namespace lamella::render::detail
