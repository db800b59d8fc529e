#include "lamella/linalg/dense.h"

#define EIGEN_MPL2_ONLY
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace lamella::linalg {

Eigen3 eigenpairs(const std::array<Vec3, 3>& symmetric) {
    Eigen::Matrix3d m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) = symmetric[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
    Eigen3 pairs;
    for (int k = 0; k < 3; ++k) {
        const auto at = static_cast<std::size_t>(k);
        pairs.value[at] = solver.eigenvalues()[k];
        pairs.vector[at] = {{solver.eigenvectors()(0, k), solver.eigenvectors()(1, k), solver.eigenvectors()(2, k)}};
    }
    return pairs;
}

Eigenpairs eigenpairs(std::size_t n, std::span<const double> matrix) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto size = static_cast<Eigen::Index>(n);
    const Eigen::Map<const RowMajor> m(matrix.data(), size, size);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(m);
    const Eigen::VectorXd& values = solver.eigenvalues();
    const Eigen::MatrixXd& vectors = solver.eigenvectors();
    return {{values.data(), values.data() + n}, {vectors.data(), vectors.data() + n * n}};
}

SymmetricSolution solve_symmetric(std::size_t n,
                                  std::span<const double> matrix,
                                  std::span<const double> b,
                                  double cutoff) {
    SymmetricSolution solution{std::vector<double>(n, 0.0)};
    if (n == 0) return solution;
    const Eigenpairs pairs = eigenpairs(n, matrix);
    const double zero = cutoff * std::max(std::abs(pairs.value.front()), std::abs(pairs.value.back()));
    for (std::size_t k = 0; k < n; ++k) {
        if (!(std::abs(pairs.value[k]) > zero)) continue;
        if (pairs.value[k] < 0.0) ++solution.negative;
        const double* vector = &pairs.vector[k * n];
        double along = 0.0;
        for (std::size_t i = 0; i < n; ++i) along += vector[i] * b[i];
        for (std::size_t i = 0; i < n; ++i) solution.x[i] += along / pairs.value[k] * vector[i];
    }
    return solution;
}

}  // namespace lamella::linalg
