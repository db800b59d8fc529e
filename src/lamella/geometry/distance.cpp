#include "lamella/geometry/distance.h"

#include <algorithm>

namespace lamella::geometry {
namespace {

// Squared sine below which products of dot products lose the digits that products of cross products keep: their
// difference is wrong by 1e-16, which makes points found on needles, and on segments that are nearly parallel, those of
// some place else.
constexpr double kThin = 1e-4;

double clamped(double numerator, double denominator) {
    return denominator > 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;
}

}  // namespace

// Walks the regions of the plane around the triangle: corners, edges, inside.
NearestOnTriangle nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 n = cross(ab, ac);
    const bool needle = squared_norm(n) < kThin * squared_norm(ab) * squared_norm(ac);
    const auto part = [&](double difference, const Vec3& x, const Vec3& y) {  // Lagrange's identity
        return needle ? dot(n, cross(p - x, p - y)) : difference;
    };
    const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
    if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
    const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
    if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
    const double on_ab = part(d1 * d4 - d3 * d2, a, b);
    if (on_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double v = clamped(d1, d1 - d3);
        return {1.0 - v, v, 0.0};
    }
    const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
    if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
    const double on_ac = part(d5 * d2 - d1 * d6, c, a);
    if (on_ac <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double w = clamped(d2, d2 - d6);
        return {1.0 - w, 0.0, w};
    }
    const double on_bc = part(d3 * d6 - d5 * d4, b, c);
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

// The foot on a needle is found along it to rounding over its height only: what is left along the longest edge is that.
double squared_distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto [u, v, w] = nearest_on_triangle(p, a, b, c);
    Vec3 rest = p - (u * a + v * b + w * c);
    if (u > 0.0 && v > 0.0 && w > 0.0) {
        Vec3 along = b - a;
        for (const Vec3& edge : {c - b, a - c})
            if (squared_norm(edge) > squared_norm(along)) along = edge;
        rest -= dot(rest, along) / squared_norm(along) * along;
    }
    return squared_norm(rest);
}

// The nearest points of the two lines, clamped to the segments one after the other.
double squared_distance_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a;
    const Vec3 v = d - c;
    const Vec3 r = a - c;
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
    double along = uv * vr - ur * vv, determinant = uu * vv - uv * uv;
    if (determinant < kThin * uu * vv) {
        const Vec3 n = cross(u, v);
        along = dot(n, cross(v, r));
        determinant = squared_norm(n);
    }
    double s = clamped(along, determinant);
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
