#include "lamella/mesh/detail/quadratic_slope.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace lamella::mesh::detail {
namespace {

constexpr std::size_t kTerms = 6;
using Vector6 = std::array<double, kTerms>;

/// Lower triangle of a symmetric matrix, rows of full length.
using Matrix6 = std::array<Vector6, kTerms>;

/// Solves A x = b in place by Cholesky's method. False if A is singular to working precision.
bool solve_positive(Matrix6& a, Vector6& b) {
    for (std::size_t i = 0; i < kTerms; ++i) {
        const double diagonal = a[i][i];
        for (std::size_t j = 0; j <= i; ++j) {
            for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
            if (j < i) a[i][j] /= a[j][j];
        }
        if (!(a[i][i] > 1e-9 * diagonal)) return false;  // this term is nearly a combination of those before it
        a[i][i] = std::sqrt(a[i][i]);
        for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    for (std::size_t i = kTerms; i-- > 0;) {
        for (std::size_t k = i + 1; k < kTerms; ++k) b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
    return true;
}

}  // namespace

std::optional<Vec2> quadratic_slope(std::span<const Vec3> points, double scale) {
    Matrix6 normal{};
    Vector6 right{};
    for (const Vec3& point : points) {
        const double u = point[0] / scale;
        const double v = point[1] / scale;
        const double weight = 1.0 / (1.0 + u * u + v * v);
        const Vector6 term{1.0, u, v, u * u, u * v, v * v};
        for (std::size_t i = 0; i < kTerms; ++i) {
            right[i] += weight * term[i] * point[2] / scale;
            for (std::size_t j = 0; j <= i; ++j) normal[i][j] += weight * term[i] * term[j];
        }
    }
    if (!solve_positive(normal, right)) return std::nullopt;
    return Vec2{{right[1], right[2]}};
}

}  // namespace lamella::mesh::detail
