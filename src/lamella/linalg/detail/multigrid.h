#pragma once

#include "lamella/linalg/symmetric_matrix.h"

#include <memory>
#include <span>

namespace lamella::linalg::detail {

/// Algebraic multigrid for a sparse symmetric positive definite matrix: one V-cycle as an operator, symmetric and
/// positive definite itself. On one thread; several may not use one object at once.
class Multigrid {
public:
    virtual ~Multigrid() = default;
    /// result = about A^-1 x
    virtual void cycle(std::span<const double> x, std::span<double> result) const = 0;
};

/// Whether this build has it.
bool has_multigrid();
/// @returns nothing where the build has none, or the matrix admits none
std::unique_ptr<Multigrid> make_multigrid(const SymmetricMatrix& matrix);

}  // namespace lamella::linalg::detail
