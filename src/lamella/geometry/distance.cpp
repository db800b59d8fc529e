#include "lamella/geometry/distance.h"

#include <algorithm>

namespace lamella::geometry {
namespace {

double clamped(double numerator, double denominator) {
    return denominator > 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
}

}  // namespace

// Walks the regions of the plane around the triangle: corners, edges, inside.
NearestOnTriangle nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
    if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
    const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
    if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
    const double on_ab = d1 * d4 - d3 * d2;
    if (on_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double v = clamped(d1, d1 - d3);
        return {1.0 - v, v, 0.0};
    }
    const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
    if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
    const double on_ac = d5 * d2 - d1 * d6;
    if (on_ac <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double w = clamped(d2, d2 - d6);
        return {1.0 - w, 0.0, w};
    }
    const double on_bc = d3 * d6 - d5 * d4;
    if (on_bc <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double w = clamped(d4 - d3, (d4 - d3) + (d5 - d6));
        return {0.0, 1.0 - w, w};
    }
    const double scale = 1.0 / (on_bc + on_ac + on_ab);
    return {on_bc * scale, on_ac * scale, on_ab * scale};
}

double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double t = clamped(dot(ab, p - a), dot(ab, ab));
    return squared_norm(p - (a + t * ab));
}

double squared_distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto [u, v, w] = nearest_on_triangle(p, a, b, c);
    return squared_norm(p - (u * a + v * b + w * c));
}

// The nearest points of the two lines, clamped to the segments one after the other.
double squared_distance_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a;
    const Vec3 v = d - c;
    const Vec3 r = a - c;
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
    double s = clamped(uv * vr - ur * vv, uu * vv - uv * uv);
    double t = vv > 0.0 ? (uv * s + vr) / vv : 0.0;
    if (t < 0.0) {
        t = 0.0;
        s = clamped(-ur, uu);
    } else if (t > 1.0) {
        t = 1.0;
        s = clamped(uv - ur, uu);
    } else if (vv == 0.0) {
        s = clamped(-ur, uu);
    }
    return squared_norm(r + s * u - t * v);
}

}  // namespace lamella::geometry
