#pragma once

#include "lamella/core/vec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lamella::mesh::detail {

/// Twice the area times the unit normal.
inline Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) { return cross(b - a, c - a); }
inline Vec3 area_vector(const std::array<Vec3, 3>& t) { return area_vector(t[0], t[1], t[2]); }

inline double area(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * norm(area_vector(a, b, c)); }

/// Cotangent of the angle at `apex`: large for a sharp corner, negative for an obtuse one.
inline double cot_at(const Vec3& apex, const Vec3& b, const Vec3& c) {
    const Vec3 u = b - apex;
    const Vec3 w = c - apex;
    const double sine = norm(cross(u, w));
    const double cosine = dot(u, w);
    return sine > 0.0 ? cosine / sine : (cosine > 0.0 ? 1e300 : -1e300);
}

/// Cotangent of the smallest angle; 1e300 for a face without area. Comparing these needs no trigonometry.
inline double sharpest_cot(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double twice_area = norm(area_vector(a, b, c));
    const double largest_dot = std::max({dot(b - a, c - a), dot(a - b, c - b), dot(a - c, b - c)});
    return twice_area > 0.0 ? largest_dot / twice_area : 1e300;
}
inline double sharpest_cot(const std::array<Vec3, 3>& t) { return sharpest_cot(t[0], t[1], t[2]); }

inline double cot_of_degrees(double degrees) { return 1.0 / std::tan(degrees * 3.14159265358979323846 / 180.0); }

}  // namespace lamella::mesh::detail
