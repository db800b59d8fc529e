#include "lamella/solvers/vortex_sheet/implicit_step.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/linalg/gmres.h"
#include "lamella/solvers/vortex_sheet/step_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::vortex_sheet {
namespace {

using mesh::FoamMesh;
using mesh::VertexId;

/// Change of the rate per time while the vertices move with `velocity`: a one-sided difference over a millionth of an
/// edge, whose error, about as large relative to the derivative, is far below what GMRES leaves.
class RateDerivative {
public:
    RateDerivative(const ImplicitProblem& problem) : problem_(problem), rate_(problem.rate(problem.middle)) {}

    const Circulation& rate() const { return rate_; }

    Circulation along(const VertexVelocity& velocity) const {
        double fastest = 0.0;
        for (const Vec3& u : velocity) fastest = std::max(fastest, norm(u));
        if (fastest == 0.0) return Circulation(rate_.size(), 0.0);
        constexpr double kStep = 1e-6;  // edges
        const double time = kStep * problem_.edge_length / fastest;
        FoamMesh moved = problem_.middle;
        for (const VertexId v : moved.position.ids()) moved.position[v] += time * velocity[v];
        Circulation change = problem_.rate(moved);
        for (std::size_t i = 0; i < change.size(); ++i) change[i] = (change[i] - rate_[i]) / time;
        return change;
    }

private:
    const ImplicitProblem& problem_;
    Circulation rate_;
};

}  // namespace

ImplicitStep implicit_step(const ImplicitProblem& problem, const Circulation& phi, double theta, double dt) {
    const RateDerivative derivative(problem);
    const double half = theta * dt;
    const Circulation expected = derivative.along(problem.expected);
    Circulation right = phi, middle = phi;
    for (std::size_t i = 0; i < phi.size(); ++i) right[i] += half * (derivative.rate()[i] - half * expected[i]);

    std::vector<VertexVelocity> velocity;  // of the vectors that GMRES asks about; the first is phi itself
    const auto apply = [&](const Circulation& x, Circulation& y) {
        velocity.push_back(problem.velocity(x, velocity.empty()));
        const Circulation change = derivative.along(velocity.back());
        y = x;
        for (std::size_t i = 0; i < x.size(); ++i) y[i] -= half * half * change[i];
    };
    constexpr int kMostIterations = 60;
    const linalg::GmresSolution done =
        linalg::gmres(apply, problem.precondition, right, middle, problem.tolerance, kMostIterations);
    if (!(done.residual <= problem.tolerance))
        throw NumericalError(fmt::format("semi-implicit tension: no convergence in {} iterations for a step of {:.3g} s, "
                                         "residual {:.1e}; vortex_sheet.tension = \"explicit\" does without",
                                         done.iterations, dt, done.residual));
    if (velocity.empty()) velocity.push_back(problem.velocity(middle, true));  // no circulation and none to come

    ImplicitStep step{.dt = dt,
                      .phi = phi,
                      .velocity = velocity.front(),
                      .evaluations = static_cast<int>(velocity.size()),
                      .residual = done.residual};
    for (std::size_t i = 0; i < phi.size(); ++i) step.phi[i] += (middle[i] - phi[i]) / theta;
    for (const VertexId v : step.velocity.ids())
        for (std::size_t k = 0; k < done.weight.size(); ++k) step.velocity[v] += done.weight[k] * velocity[k + 1][v];
    return step;
}

FilmFilter flat_film_inverse(const FilmLaplacian& laplacian,
                             const spatial::VortexSumOptions& sum,
                             double surface_tension,
                             double density,
                             double theta_dt) {
    const double factor = theta_dt * theta_dt * surface_tension / density;
    constexpr int kDegree = 24;
    return {laplacian,
            [=](double eigenvalue) {
                const double k = std::sqrt(eigenvalue);
                return 1.0 / (1.0 + factor * k * k * k * kernel_factor(sum.kernel, k * sum.delta));
            },
            kDegree};
}

}  // namespace lamella::vortex_sheet
