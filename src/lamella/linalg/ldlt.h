#pragma once

#include "lamella/linalg/symmetric_matrix.h"

#include <cstddef>
#include <memory>
#include <span>

namespace lamella::linalg {

/// P A P^T = L D L^T of a sparse symmetric matrix, without pivoting: for matrices that are definite or, with luck,
/// not. The signs of D count the negative eigenvalues of A (Sylvester's law of inertia).
class Ldlt {
public:
    Ldlt();
    ~Ldlt();
    Ldlt(Ldlt&&) noexcept;
    Ldlt& operator=(Ldlt&&) noexcept;

    /// Chooses the elimination order (approximate minimum degree) for all matrices with this pattern.
    void analyze(const SymmetricMatrix& pattern);
    /// @returns false when a pivot is zero or not finite; then nothing may be solved
    bool factorize(const SymmetricMatrix& matrix);
    std::size_t negative_pivots() const;
    /// x = A^-1 x, in place. Safe to call from several threads at once.
    void solve(std::span<double> x) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lamella::linalg
