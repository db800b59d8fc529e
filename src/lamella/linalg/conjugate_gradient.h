#pragma once

#include "lamella/core/parallel.h"
#include "lamella/core/vec.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella::linalg {

/// How far an iterative solution went.
struct IterativeSolution {
    int iterations = 0;
    double residual = 0.0;  ///< |b - A x| / |b|, 0 for b = 0
};

/// Conjugate gradients for a symmetric positive semi-definite operator, from the given x.
///
/// @param apply         apply(x, y): y = A x for vectors of b's length
/// @param precondition  precondition(u, v): v about A^-1 u, of a symmetric positive definite operator
/// @param tolerance     of the residual, relative to |b|
/// @param x             the start, and the answer
template <class Operator, class Preconditioner>
IterativeSolution preconditioned_conjugate_gradient(Operator&& apply,
                                                    Preconditioner&& precondition,
                                                    const std::vector<double>& b,
                                                    std::vector<double>& x,
                                                    double tolerance,
                                                    int most_iterations) {
    const std::size_t n = b.size();
    const auto dot = [n](const std::vector<double>& u, const std::vector<double>& v) {
        return parallel_sum(n, [&](std::size_t i) { return u[i] * v[i]; });
    };
    std::vector<double> residual(n), direction, image(n), scaled;
    apply(x, image);
    parallel_for(n, [&](std::size_t i) { residual[i] = b[i] - image[i]; });
    const double size = std::sqrt(dot(b, b));
    IterativeSolution done{0, size > 0.0 ? std::sqrt(dot(residual, residual)) / size : 0.0};
    if (size == 0.0) {
        x.assign(n, 0.0);
        return done;
    }
    precondition(residual, scaled);
    direction = scaled;
    double product = dot(residual, scaled);
    while (done.iterations < most_iterations && done.residual > tolerance) {
        apply(direction, image);
        // A direction that the operator hardly sees leads far away for nothing: no better solution is to be had.
        constexpr double kBlind = 1e-10;
        const Vec3 seen = parallel_sum(n, [&](std::size_t i) {
            return Vec3{{direction[i] * image[i], direction[i] * direction[i], image[i] * image[i]}};
        });
        if (!(seen[0] > kBlind * std::sqrt(seen[1] * seen[2]))) break;
        const double step = product / seen[0];
        const double squares = parallel_sum(n, [&](std::size_t i) {
            x[i] += step * direction[i];
            residual[i] -= step * image[i];
            return residual[i] * residual[i];
        });
        precondition(residual, scaled);
        const double next = dot(residual, scaled);
        parallel_for(n, [&](std::size_t i) { direction[i] = scaled[i] + (next / product) * direction[i]; });
        product = next;
        ++done.iterations;
        done.residual = std::sqrt(squares) / size;
    }
    return done;
}

/// The same with the inverse of a diagonal preconditioner in `scale`, or with none where that is empty.
template <class Operator>
IterativeSolution conjugate_gradient(Operator&& apply,
                                     const std::vector<double>& scale,
                                     const std::vector<double>& b,
                                     std::vector<double>& x,
                                     double tolerance,
                                     int most_iterations) {
    const auto precondition = [&scale](const std::vector<double>& u, std::vector<double>& v) {
        if (scale.empty()) {
            v = u;
            return;
        }
        v.resize(u.size());
        parallel_for(u.size(), [&](std::size_t i) { v[i] = scale[i] * u[i]; });
    };
    return preconditioned_conjugate_gradient(apply, precondition, b, x, tolerance, most_iterations);
}

}  // namespace lamella::linalg
