#include "lamella/film/wire.h"

#include <algorithm>
#include <cmath>

namespace lamella::film {

Vec3 Wire::carried(const Vec3& x, double from, double to) const {
    const double before = std::clamp(from, start, end) - start;
    const double after = std::clamp(to, start, end) - start;
    if (after == before) return x;
    const Vec3 arm = x - (center + before * velocity);
    const Vec3 pivot = center + after * velocity;
    const double rate = norm(spin);
    if (rate == 0.0) return pivot + arm;
    // The formula of Rodrigues.
    const Vec3 axis = spin / rate;
    const double angle = rate * (after - before);
    return pivot + std::cos(angle) * arm + std::sin(angle) * cross(axis, arm) +
           ((1.0 - std::cos(angle)) * dot(axis, arm)) * axis;
}

}  // namespace lamella::film
