#pragma once

#include "lamella/core/simd.h"

#include <array>
#include <cstddef>

namespace lamella::linalg {

/// A small positive definite matrix as A = L L^T, in place; eight at once where T is lanes.
///
/// @param a  N x N, row by row; only its lower triangle is read, and overwritten by L, with 1 / L_ii on the diagonal
/// @returns  false where A is not safely positive definite: a pivot below `cutoff` times its diagonal entry. Then `a`
///           is no factor.
template <std::size_t N, class T>
auto factor_positive(std::array<T, N * N>& a, double cutoff = 1e-10) {
    auto definite = a[0] == a[0];
    for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            T sum = a[i * N + j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i * N + k] * a[j * N + k];
            if (i != j) {
                a[i * N + j] = sum * a[j * N + j];
            } else {
                const auto safe = sum > cutoff * a[i * N + i];
                definite = definite && safe;
                a[i * N + i] = 1.0 / square_root(select(safe, sum, T(1.0)));
            }
        }
    return definite;
}

/// Solves A x = b in place, with what factor_positive() has made of A.
template <std::size_t N, class T>
void solve_factored(const std::array<T, N * N>& factor, std::array<T, N>& b) {
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
