#include "lamella/linalg/definite_solver.h"

#include "lamella/core/error.h"
#include "lamella/linalg/conjugate_gradient.h"
#include "lamella/linalg/detail/multigrid.h"
#include "lamella/linalg/ldlt.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace lamella::linalg {

struct DefiniteSolver::Impl {
    std::optional<DefiniteMethod> wanted;
    Refactored how_often = Refactored::kSeldom;

    DefiniteMethod method = DefiniteMethod::kFactors;
    Ldlt factors;
    SymmetricMatrix matrix;  // multigrid only
    std::unique_ptr<detail::Multigrid> multigrid;
    mutable std::mutex one_at_a_time;

    void cycle(std::span<const double> x, std::span<double> result) const {
        const std::lock_guard lock(one_at_a_time);
        multigrid->cycle(x, result);
    }
};

DefiniteMethod cheaper_method(std::size_t unknowns, Refactored how_often) {
    constexpr std::size_t kLarge = 30'000;
    const bool multigrid = how_often == Refactored::kOften && unknowns >= kLarge && has_multigrid();
    return multigrid ? DefiniteMethod::kMultigrid : DefiniteMethod::kFactors;
}

bool has_multigrid() { return detail::has_multigrid(); }

DefiniteSolver::DefiniteSolver(Refactored how_often) : impl_(std::make_unique<Impl>()) { impl_->how_often = how_often; }
DefiniteSolver::DefiniteSolver(DefiniteMethod method) : impl_(std::make_unique<Impl>()) {
    if (method == DefiniteMethod::kMultigrid && !has_multigrid())
        throw InputError("this build has no multigrid (hypre)");
    impl_->wanted = method;
}
DefiniteSolver::~DefiniteSolver() = default;
DefiniteSolver::DefiniteSolver(DefiniteSolver&&) noexcept = default;
DefiniteSolver& DefiniteSolver::operator=(DefiniteSolver&&) noexcept = default;

void DefiniteSolver::analyze(const SymmetricMatrix& pattern) {
    impl_->method = impl_->wanted.value_or(cheaper_method(pattern.size(), impl_->how_often));
    if (impl_->method == DefiniteMethod::kFactors) impl_->factors.analyze(pattern);
}

bool DefiniteSolver::factorize(const SymmetricMatrix& matrix) {
    if (impl_->method == DefiniteMethod::kFactors)
        return impl_->factors.factorize(matrix) && impl_->factors.negative_pivots() == 0;
    impl_->matrix = matrix;
    for (std::size_t i = 0; i < matrix.size(); ++i)
        if (!(impl_->matrix.diagonal(i) > 0.0)) return false;
    impl_->multigrid = detail::make_multigrid(matrix);
    return impl_->multigrid != nullptr;
}

DefiniteMethod DefiniteSolver::method() const { return impl_->method; }

void DefiniteSolver::solve(std::span<double> x) const {
    if (impl_->method == DefiniteMethod::kFactors) return impl_->factors.solve(x);
    constexpr double kTolerance = 1e-12;
    constexpr double kWorst = 1e-9;  // rounding may end it before that
    constexpr int kMostIterations = 200;
    const std::vector<double> b(x.begin(), x.end());
    std::vector<double> solution(b.size(), 0.0);
    const auto apply = [&](const std::vector<double>& u, std::vector<double>& v) {
        v.resize(u.size());
        multiply(impl_->matrix, u, v);
    };
    const auto cycle = [&](const std::vector<double>& u, std::vector<double>& v) {
        v.resize(u.size());
        impl_->cycle(u, v);
    };
    const IterativeSolution done =
        preconditioned_conjugate_gradient(apply, cycle, b, solution, kTolerance, kMostIterations);
    if (!(done.residual <= kWorst))
        throw NumericalError("a stiff equation of " + std::to_string(b.size()) + " unknowns: multigrid stopped after " +
                             std::to_string(done.iterations) +
                             " iterations with more than 1e-9 of the right side left");
    std::copy(solution.begin(), solution.end(), x.begin());
}

void DefiniteSolver::precondition(std::span<double> x) const {
    if (impl_->method == DefiniteMethod::kFactors) return impl_->factors.solve(x);
    const std::vector<double> b(x.begin(), x.end());
    impl_->cycle(b, x);
}

}  // namespace lamella::linalg
