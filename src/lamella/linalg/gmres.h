#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella::linalg {

/// How far GMRES went.
struct GmresSolution {
    int iterations = 0;
    double residual = 0.0;  ///< |b - A x| / |b|, 0 for b = 0
    /// x = start + sum_i weight[i] * (the vector that `apply` saw i calls after that with the start). Whoever keeps
    /// what apply did to these vectors has the same of x without another call.
    std::vector<double> weight;
};

/// GMRES for any regular operator, preconditioned from the right, from the given x, without restarts: it keeps two
/// vectors per iteration. [SaadSchultz86]
///
/// @param apply         apply(x, y): y = A x for vectors of b's length
/// @param precondition  precondition(v, z): z about A^-1 v
/// @param tolerance     of the residual, relative to |b|
/// @param x             the start, and the answer
template <class Operator, class Preconditioner>
GmresSolution gmres(Operator&& apply,
                    Preconditioner&& precondition,
                    const std::vector<double>& b,
                    std::vector<double>& x,
                    double tolerance,
                    int most_iterations) {
    const std::size_t n = b.size();
    const auto dot = [n](const std::vector<double>& u, const std::vector<double>& v) {
        double sum = 0.0;
        for (std::size_t i = 0; i < n; ++i) sum += u[i] * v[i];
        return sum;
    };
    GmresSolution done;
    const double size = std::sqrt(dot(b, b));
    if (size == 0.0) {
        x.assign(n, 0.0);
        return done;
    }
    std::vector<double> image;
    apply(x, image);
    std::vector<std::vector<double>> basis(1, b), seen;
    for (std::size_t i = 0; i < n; ++i) basis[0][i] -= image[i];
    double left = std::sqrt(dot(basis[0], basis[0]));
    if (left > 0.0)
        for (double& value : basis[0]) value /= left;
    // The least squares problem min |left e_0 - H weight|, its columns made triangular by rotations as they come.
    std::vector<std::vector<double>> column;
    std::vector<double> cosine, sine, right{left};
    while (done.iterations < most_iterations && left > tolerance * size) {
        const std::size_t k = column.size();
        seen.emplace_back();
        precondition(basis[k], seen[k]);
        apply(seen[k], image);
        std::vector<double> h(k + 2);
        for (std::size_t j = 0; j <= k; ++j) {
            h[j] = dot(basis[j], image);
            for (std::size_t i = 0; i < n; ++i) image[i] -= h[j] * basis[j][i];
        }
        h[k + 1] = std::sqrt(dot(image, image));
        const double next = h[k + 1];
        for (std::size_t j = 0; j < k; ++j) {
            const double upper = cosine[j] * h[j] + sine[j] * h[j + 1];
            h[j + 1] = cosine[j] * h[j + 1] - sine[j] * h[j];
            h[j] = upper;
        }
        const double length = std::hypot(h[k], h[k + 1]);
        if (!(length > 0.0)) break;  // the operator does not see this direction: no better to be had
        cosine.push_back(h[k] / length);
        sine.push_back(h[k + 1] / length);
        h[k] = length;
        h.resize(k + 1);
        column.push_back(std::move(h));
        right.push_back(-sine[k] * right[k]);
        right[k] *= cosine[k];
        left = std::abs(right[k + 1]);
        ++done.iterations;
        if (!(next > 0.0)) break;  // the answer lies in what has been seen
        basis.push_back(image);
        for (double& value : basis.back()) value /= next;
    }
    done.residual = left / size;
    done.weight.assign(column.size(), 0.0);
    for (std::size_t k = column.size(); k-- > 0;) {
        double sum = right[k];
        for (std::size_t j = k + 1; j < column.size(); ++j) sum -= column[j][k] * done.weight[j];
        done.weight[k] = sum / column[k][k];
    }
    for (std::size_t k = 0; k < column.size(); ++k)
        for (std::size_t i = 0; i < n; ++i) x[i] += done.weight[k] * seen[k][i];
    return done;
}

}  // namespace lamella::linalg
