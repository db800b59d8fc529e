#include "lamella/geometry/curved_triangle.h"

#include <vector>

namespace lamella::geometry {

Vec3 edge_conormal(const CurvedTriangle& x, std::size_t opposite) {
    const std::size_t tail = (opposite + 1) % 3, head = (opposite + 2) % 3;
    const Vec3 inward = 2.0 * (x[3 + head] + x[3 + opposite] - x[3 + tail]) - x[opposite] - 0.5 * (x[tail] + x[head]);
    const Vec3 along = x[head] - x[tail];
    return inward - (dot(inward, along) / squared_norm(along)) * along;
}

/// sum_j L_j'(t_0) x_j with Lagrange's polynomials: L_j'(t_0) = prod_{k != 0, j} (t_0 - t_k)/(t_j - t_k) / (t_j - t_0) for
/// j > 0, and they add up to zero.
Vec3 end_tangent(std::span<const Vec3> points) {
    std::vector<double> t{0.0};
    for (std::size_t k = 1; k < points.size(); ++k) t.push_back(t.back() + norm(points[k] - points[k - 1]));
    Vec3 tangent;
    for (std::size_t j = 1; j < points.size(); ++j) {
        double slope = 1.0 / t[j];
        for (std::size_t k = 1; k < points.size(); ++k)
            if (k != j) slope *= t[k] / (t[k] - t[j]);
        tangent += slope * (points[j] - points[0]);
    }
    return tangent;
}

}  // namespace lamella::geometry
