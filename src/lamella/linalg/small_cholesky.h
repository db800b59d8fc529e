#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace lamella::linalg {

/// A small positive definite matrix as A = L L^T, in place.
///
/// @param a  N x N, row by row; only its lower triangle is read, and overwritten by L, with 1 / L_ii on the diagonal
/// @returns  false where A is not safely positive definite: a pivot below `cutoff` times its diagonal entry. Then `a`
///           is no factor.
template <std::size_t N>
bool factor_positive(std::array<double, N * N>& a, double cutoff = 1e-10) {
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = a[i * N + j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i * N + k] * a[j * N + k];
            if (i != j) {
                a[i * N + j] = sum * a[j * N + j];
            } else {
                if (!(sum > cutoff * a[i * N + i])) return false;
                a[i * N + i] = 1.0 / std::sqrt(sum);
            }
        }
    return true;
}

/// Solves A x = b in place, with what factor_positive() has made of A.
template <std::size_t N>
void solve_factored(const std::array<double, N * N>& factor, std::array<double, N>& b) {
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= factor[i * N + k] * b[k];
        b[i] *= factor[i * N + i];
    }
    for (std::size_t i = N; i-- > 0;) {
        for (std::size_t k = i + 1; k < N; ++k) b[i] -= factor[k * N + i] * b[k];
        b[i] *= factor[i * N + i];
    }
}

/// Both. @returns false where A is not safely positive definite; then `b` is no answer.
template <std::size_t N>
bool solve_positive(std::array<double, N * N>& a, std::array<double, N>& b, double cutoff = 1e-10) {
    if (!factor_positive<N>(a, cutoff)) return false;
    solve_factored<N>(a, b);
    return true;
}

}  // namespace lamella::linalg
