#pragma once

#include "lamella/core/vec.h"

#include <cmath>

namespace lamella::geometry {

// Signs of determinants of coordinates, exact for all coordinates whose products neither overflow nor underflow
// (about 1e-70 to 1e+70 apart from zero). A filter [Shewchuk97] decides nearly all calls in a few nanoseconds.

namespace detail {
int exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
int exact_orient2d(const Vec2& a, const Vec2& b, const Vec2& c);
}  // namespace detail

/// Sign of det[b - a, c - a, d - a]: +1 when d lies on the side of the plane abc that (b - a) x (c - a) points to, -1
/// on the other side, 0 in the plane.
inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    // Rounding errors stay below (7 + 56 eps) eps = 7.8e-16 of the sum of the absolute products, fused or not.
    constexpr double kBound = 1e-15;
    const Vec3 u = b - a;
    const Vec3 v = c - a;
    const Vec3 w = d - a;
    const double yz = v[1] * w[2], zy = v[2] * w[1];
    const double zx = v[2] * w[0], xz = v[0] * w[2];
    const double xy = v[0] * w[1], yx = v[1] * w[0];
    const double det = u[0] * (yz - zy) + u[1] * (zx - xz) + u[2] * (xy - yx);
    const double size = std::abs(u[0]) * (std::abs(yz) + std::abs(zy)) +
                        std::abs(u[1]) * (std::abs(zx) + std::abs(xz)) + std::abs(u[2]) * (std::abs(xy) + std::abs(yx));
    const double bound = kBound * size;
    if (det > bound) return 1;
    if (det < -bound) return -1;
    return detail::exact_orient3d(a, b, c, d);
}

/// Sign of det[b - a, c - a]: +1 when a, b, c turn counterclockwise.
inline int orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
    constexpr double kBound = 4e-16;  // (3 + 16 eps) eps = 3.4e-16
    const double left = (b[0] - a[0]) * (c[1] - a[1]);
    const double right = (b[1] - a[1]) * (c[0] - a[0]);
    const double det = left - right;
    const double bound = kBound * (std::abs(left) + std::abs(right));
    if (det > bound) return 1;
    if (det < -bound) return -1;
    return detail::exact_orient2d(a, b, c);
}

}  // namespace lamella::geometry
