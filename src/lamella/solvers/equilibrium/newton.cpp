#include "lamella/solvers/equilibrium/newton.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/dense.h"

#include <algorithm>
#include <cmath>

namespace lamella::equilibrium {
namespace {

/// Rigid motions cost nothing; this makes them cost next to nothing [1 / length^2].
constexpr double kRigidShift = 1e-6;

/// Mean length of the straight edges at each node.
std::vector<double> edge_scale(const Patches& patches) {
    std::vector<double> sum(patches.position.size(), 0.0);
    std::vector<int> count(patches.position.size(), 0);
    const auto add = [&](std::uint32_t node, double length) {
        sum[node] += length;
        ++count[node];
    };
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const auto x = patches.corners(p);
        for (std::size_t k = 0; k < 3; ++k) {
            const double length = norm(x[(k + 1) % 3] - x[k]);
            add(patches.nodes[p][k], length);
            add(patches.nodes[p][(k + 1) % 3], length);
            if (patches.nodes_per_patch == 6) add(patches.nodes[p][3 + k], length);
        }
    }
    for (std::size_t node = 0; node < sum.size(); ++node)
        if (count[node] > 0) sum[node] /= count[node];
    return sum;
}

double inner(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

Newton::Direction Newton::direction(const Balance& b, double shift) {
    linalg::SymmetricMatrix matrix = system_.hessian(pressure_);
    const double unit = 1.0 / (system_.length() * system_.length());
    for (std::size_t i = 0; i < b.mass.size(); ++i) matrix.diagonal(i) += (kRigidShift + shift) * unit * b.mass[i];
    if (!analyzed_) factors_.analyze(matrix);
    analyzed_ = true;
    Direction d;
    if (!factors_.factorize(matrix)) return d;

    const std::size_t n = b.volume_slope.size();
    std::vector<std::vector<double>> y = b.volume_slope;
    std::vector<double> x = b.slope;
    for (double& v : x) v = -v;
    parallel_blocks(n + 1, 1, [&](std::size_t r, std::size_t) { factors_.solve(r < n ? y[r] : x); });

    std::vector<double> schur(n * n), right(n);
    for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t s = 0; s <= r; ++s) schur[r * n + s] = inner(b.volume_slope[r], y[s]);
        right[r] = b.missing[r] - inner(b.volume_slope[r], x);
    }
    const linalg::SymmetricSolution p = linalg::solve_symmetric(n, schur, right);
    d.index = static_cast<int>(factors_.negative_pivots()) - static_cast<int>(p.negative);
    d.pressure = p.x;
    d.dx = std::move(x);
    for (std::size_t r = 0; r < n; ++r)
        for (std::size_t i = 0; i < d.dx.size(); ++i) d.dx[i] += p.x[r] * y[r][i];
    d.solved = std::all_of(d.dx.begin(), d.dx.end(), [](double v) { return std::isfinite(v); });
    return d;
}

NewtonReport Newton::step() {
    system_.update_space();
    const Balance before = system_.balance();
    const std::vector<double> best = system_.best_pressures(before);
    if (pressure_.size() != best.size() || steps_ == 0) pressure_ = best;
    NewtonReport report;
    report.residual = RestSystem::residual(before, best);
    for (std::size_t r = 0; r < before.missing.size(); ++r)
        report.missing = std::max(report.missing, std::abs(before.missing[r]) / std::abs(system_.target(r)));

    Direction d = direction(before, shift_);
    const double unshifted_index = shift_ == 0.0 && d.solved ? d.index : -1;
    constexpr double kLargestShift = 1e6;
    while (goal_ == Goal::kMinimum && (!d.solved || d.index > 0) && shift_ < kLargestShift) {
        shift_ = std::max(4.0 * shift_, 0.5);
        d = direction(before, shift_);
    }
    report.index = unshifted_index >= 0 ? static_cast<int>(unshifted_index) : -1;
    if (!d.solved) return last_ = report;

    // No node may pass its neighbors.
    const std::vector<double> edge = edge_scale(system_.patches());
    const std::vector<Vec3> move = system_.space().expand(d.dx);
    for (std::size_t node = 0; node < move.size(); ++node)
        if (edge[node] > 0.0) report.longest_move = std::max(report.longest_move, norm(move[node]) / edge[node]);
    constexpr double kFarthest = 0.7;
    if (report.longest_move > kFarthest)
        for (double& v : d.dx) v *= kFarthest / report.longest_move;

    report.accepted = accept_shortened(before, d.dx, report.residual);
    if (report.accepted) {
        pressure_ = d.pressure;
        shift_ = shift_ > 0.1 ? 0.25 * shift_ : 0.0;
    }
    ++steps_;
    return last_ = report;
}

bool Newton::accept_shortened(const Balance& before, const std::vector<double>& dx, double residual) {
    const std::vector<Vec3> start = system_.patches().position;
    const std::vector<Vec3> move = system_.space().expand(dx);
    double lagrangian = before.area;
    for (std::size_t r = 0; r < before.missing.size(); ++r) lagrangian += pressure_[r] * before.missing[r];
    const double slope = inner(before.slope, dx);
    constexpr int kMostHalvings = 8;
    constexpr double kNear = 1e-3;  // from here on a smaller residual counts too
    double t = 1.0;
    for (int halving = 0; halving <= kMostHalvings; ++halving, t *= 0.5) {
        std::vector<Vec3> position = start;
        for (std::size_t node = 0; node < position.size(); ++node) position[node] += t * move[node];
        system_.set_positions(system_.project_volumes(std::move(position), 3));
        const Balance after = system_.balance(residual < kNear || goal_ == Goal::kStationary);
        const double allowed = lagrangian + 1e-4 * t * std::min(slope, 0.0);
        if (goal_ == Goal::kMinimum && std::isfinite(after.area) && after.area <= allowed) return true;
        if (!after.slope.empty() &&
            RestSystem::residual(after, system_.best_pressures(after)) < (1.0 - 0.1 * t) * residual)
            return true;
    }
    system_.set_positions(start);
    return false;
}

bool Newton::solve(double tolerance, int most_steps) {
    system_.update_space();
    system_.set_positions(system_.project_volumes(system_.patches().position, 10));
    for (int k = 0; k < most_steps; ++k) {
        const NewtonReport report = step();
        if (report.residual < tolerance && report.missing < 1e-10) return true;
        if (!report.accepted) return false;
    }
    return false;
}

}  // namespace lamella::equilibrium
