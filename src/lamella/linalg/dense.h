#pragma once

#include "lamella/core/vec.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lamella::linalg {

/// Eigenvalues of a 3 x 3 symmetric matrix, ascending, with orthonormal eigenvectors.
struct Eigen3 {
    std::array<double, 3> value;
    std::array<Vec3, 3> vector;
};
Eigen3 eigenpairs(const std::array<Vec3, 3>& symmetric);

/// Eigenvalues of a dense symmetric matrix, ascending, and eigenvectors: entry i of vector k at vector[k * n + i].
struct Eigenpairs {
    std::vector<double> value;
    std::vector<double> vector;
};
/// @param matrix  n x n, only its lower triangle (row i, column j <= i, at [i * n + j]) is read
Eigenpairs eigenpairs(std::size_t n, std::span<const double> matrix);

/// The solution of matrix * x = b with least |x| for a dense symmetric matrix that may be indefinite or singular:
/// eigenvalues below `cutoff` times the largest count as zero.
struct SymmetricSolution {
    std::vector<double> x;
    std::size_t negative = 0;  ///< eigenvalues below zero
};
SymmetricSolution solve_symmetric(std::size_t n,
                                  std::span<const double> matrix,
                                  std::span<const double> b,
                                  double cutoff = 1e-13);

}  // namespace lamella::linalg
