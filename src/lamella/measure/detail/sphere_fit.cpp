#include "lamella/measure/detail/sphere_fit.h"

#include <array>
#include <cmath>
#include <limits>

namespace lamella::measure::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 times(const std::array<Vec3, 3>& m, const Vec3& x) { return {{dot(m[0], x), dot(m[1], x), dot(m[2], x)}}; }

/// Adjugate of a symmetric matrix: its inverse times its determinant.
std::array<Vec3, 3> adjugate(const std::array<Vec3, 3>& m) {
    return {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
}

}  // namespace

/// With the origin in the weighted mean:  2 C c = q,  R^2 = |c|^2 + <|x|^2>,  C = <x x^T>, q = <x |x|^2>.
double fit_sphere_radius(std::span<const WeightedPoint> points) {
    if (points.size() < 4) return kInfinity;
    Vec3 mean;
    double weight = 0.0;
    for (const WeightedPoint& p : points) {
        mean += p.weight * p.at;
        weight += p.weight;
    }
    if (!(weight > 0.0)) return kInfinity;
    mean *= 1.0 / weight;
    double square = 0.0;
    for (const WeightedPoint& p : points) square += p.weight / weight * squared_norm(p.at - mean);
    const double size = std::sqrt(square);
    if (!(size > 0.0)) return kInfinity;

    std::array<Vec3, 3> second{};
    Vec3 third;
    for (const WeightedPoint& p : points) {
        const Vec3 x = (p.at - mean) / size;
        const double w = p.weight / weight;
        for (std::size_t k = 0; k < 3; ++k) second[k] += (w * x[k]) * x;
        third += (w * squared_norm(x)) * x;
    }
    // A cap of curvature k has a determinant of order k^2 in units of its size: beyond a millionth it counts as flat.
    const double determinant = dot(second[0], cross(second[1], second[2]));
    constexpr double kFlat = 1e-14;
    if (determinant < kFlat) return kInfinity;
    const Vec3 center = (0.5 / determinant) * times(adjugate(second), third);
    return size * std::sqrt(squared_norm(center) + 1.0);
}

}  // namespace lamella::measure::detail
