#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace lamella::linalg {

/// Solves A x = b in place for a small positive definite matrix: A = L L^T.
///
/// @param a  N x N, row by row; only its lower triangle is read, and overwritten by L
/// @param b  right side, and the answer
/// @returns  false where A is not safely positive definite: a pivot below `cutoff` times its diagonal entry. Then `b`
/// is
///           no answer.
template <std::size_t N>
bool solve_positive(std::array<double, N * N>& a, std::array<double, N>& b, double cutoff = 1e-10) {
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = a[i * N + j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i * N + k] * a[j * N + k];
            if (i != j) {
                a[i * N + j] = sum / a[j * N + j];
            } else {
                if (!(sum > cutoff * a[i * N + i])) return false;
                a[i * N + i] = std::sqrt(sum);
            }
        }
        for (std::size_t k = 0; k < i; ++k) b[i] -= a[i * N + k] * b[k];
        b[i] /= a[i * N + i];
    }
    for (std::size_t i = N; i-- > 0;) {
        for (std::size_t k = i + 1; k < N; ++k) b[i] -= a[k * N + i] * b[k];
        b[i] /= a[i * N + i];
    }
    return true;
}

}  // namespace lamella::linalg
