#include "lamella/geometry/curved_triangle.h"

#include <algorithm>
#include <vector>

namespace lamella::geometry {

Vec3 point_on(const CurvedTriangle& x, const std::array<double, 3>& barycentric) {
    const auto& b = barycentric;
    Vec3 point;
    for (std::size_t k = 0; k < 3; ++k)
        point += b[k] * (2.0 * b[k] - 1.0) * x[k] + 4.0 * b[k] * b[(k + 1) % 3] * x[3 + k];
    return point;
}

Vec3 edge_conormal(const CurvedTriangle& x, std::size_t opposite) {
    const std::size_t tail = (opposite + 1) % 3, head = (opposite + 2) % 3;
    const Vec3 inward = 2.0 * (x[3 + head] + x[3 + opposite] - x[3 + tail]) - x[opposite] - 0.5 * (x[tail] + x[head]);
    const Vec3 along = x[head] - x[tail];
    return inward - (dot(inward, along) / squared_norm(along)) * along;
}

/// By orthogonal polynomials over the points: q_k+1 = (t - a_k) q_k - b_k q_k-1, with their slopes at t = 0.
Vec3 end_tangent(std::span<const Vec3> points, std::size_t degree) {
    const std::size_t n = points.size();
    std::vector<double> t{0.0};
    for (std::size_t k = 1; k < n; ++k) t.push_back(t.back() + norm(points[k] - points[k - 1]));
    std::vector<double> before(n, 0.0), q(n, 1.0);
    double slope_before = 0.0, slope = 0.0, value = 1.0, value_before = 0.0, size_before = 1.0;
    Vec3 tangent;
    for (std::size_t k = 0; k <= std::min(degree, n - 1); ++k) {
        double size = 0.0, mean = 0.0;
        Vec3 share;
        for (std::size_t i = 0; i < n; ++i) {
            size += q[i] * q[i];
            mean += q[i] * q[i] * t[i];
            share += q[i] * (points[i] - points[0]);
        }
        tangent += (slope / size) * share;
        const double a = mean / size, b = k > 0 ? size / size_before : 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const double next = (t[i] - a) * q[i] - b * before[i];
            before[i] = q[i];
            q[i] = next;
        }
        const double next_slope = value - a * slope - b * slope_before, next_value = -a * value - b * value_before;
        slope_before = slope;
        slope = next_slope;
        value_before = value;
        value = next_value;
        size_before = size;
    }
    return tangent;
}

}  // namespace lamella::geometry
