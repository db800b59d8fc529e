#include "lamella/linalg/ldlt.h"

#define EIGEN_MPL2_ONLY
#include <Eigen/SparseCholesky>

namespace lamella::linalg {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

Eigen::Map<const Sparse> view(const SymmetricMatrix& m) {
    const auto size = static_cast<Eigen::Index>(m.size());
    return {size, size, static_cast<Eigen::Index>(m.row.size()), m.column_start.data(), m.row.data(), m.value.data()};
}

}  // namespace

struct Ldlt::Impl {
    Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::AMDOrdering<int>> factors;
};

Ldlt::Ldlt() : impl_(std::make_unique<Impl>()) {}
Ldlt::~Ldlt() = default;
Ldlt::Ldlt(Ldlt&&) noexcept = default;
Ldlt& Ldlt::operator=(Ldlt&&) noexcept = default;

void Ldlt::analyze(const SymmetricMatrix& pattern) { impl_->factors.analyzePattern(view(pattern)); }

bool Ldlt::factorize(const SymmetricMatrix& matrix) {
    impl_->factors.factorize(view(matrix));
    return impl_->factors.info() == Eigen::Success && impl_->factors.vectorD().allFinite();
}

std::size_t Ldlt::negative_pivots() const {
    return static_cast<std::size_t>((impl_->factors.vectorD().array() < 0.0).count());
}

void Ldlt::solve(std::span<double> x) const {
    Eigen::Map<Eigen::VectorXd> view(x.data(), static_cast<Eigen::Index>(x.size()));
    view = impl_->factors.solve(view).eval();
}

}  // namespace lamella::linalg
