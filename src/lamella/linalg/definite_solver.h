#pragma once

#include "lamella/linalg/symmetric_matrix.h"

#include <cstddef>
#include <memory>
#include <span>

namespace lamella::linalg {

/// How a sparse symmetric positive definite equation is solved.
enum class DefiniteMethod {
    kFactors,    ///< by Cholesky factors: each solution costs little, the factors of large matrices a lot
    kMultigrid,  ///< by conjugate gradients over multigrid cycles: linear in the unknowns; where the build has it
};

/// How often a matrix of one pattern takes new values: what makes up for the cost of factors.
enum class Refactored {
    kSeldom,  ///< thousands of solutions with each
    kOften,   ///< some solutions with each
};

/// The method that is cheaper for so many unknowns of a film (docs/performance.md has the measurement).
DefiniteMethod cheaper_method(std::size_t unknowns, Refactored how_often);
/// Whether this build has multigrid.
bool has_multigrid();

/// A x = b for a sparse symmetric positive definite matrix, by the method that its size asks for.
class DefiniteSolver {
public:
    explicit DefiniteSolver(Refactored how_often);
    /// @throws InputError  this build has no multigrid
    explicit DefiniteSolver(DefiniteMethod method);
    ~DefiniteSolver();
    DefiniteSolver(DefiniteSolver&&) noexcept;
    DefiniteSolver& operator=(DefiniteSolver&&) noexcept;

    /// Prepares for all matrices with this pattern.
    void analyze(const SymmetricMatrix& pattern);
    /// @returns false when the matrix is not definite; then nothing may be solved
    bool factorize(const SymmetricMatrix& matrix);
    DefiniteMethod method() const;

    /// x = A^-1 x, in place: to rounding, or to a residual of 1e-12.
    /// @throws NumericalError  multigrid does not get there
    void solve(std::span<double> x) const;
    /// x = about A^-1 x, by a symmetric positive definite operator: for conjugate gradients with a matrix near this
    /// one.
    void precondition(std::span<double> x) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lamella::linalg
