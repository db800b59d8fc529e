#include "lamella/solvers/vortex_particle/flow.h"

#include "lamella/core/error.h"
#include "lamella/linalg/conjugate_gradient.h"

#include <algorithm>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

constexpr double kLaggingTolerance = 1e-10;
constexpr int kMostIterations = 200;

linalg::Refactored refactored(Films films) {
    return films == Films::kMoving ? linalg::Refactored::kOften : linalg::Refactored::kSeldom;
}

/// Numbers the unknowns: one per vertex, but none where `fixed`, and that of its `joint` where there are some.
template <class Fixed>
std::vector<int> numbered(const Surface& s, Fixed&& fixed, std::span<const std::uint32_t> joint = {}) {
    std::vector<int> unknown(s.vertices(), -1);
    int next = 0;
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        if (!joint.empty() && joint[v] != v)
            unknown[v] = unknown[joint[v]];
        else if (!fixed(v))
            unknown[v] = next++;
    }
    return unknown;
}

/// The first vertex of each component.
std::vector<std::size_t> first_vertices(const Surface& s) {
    std::vector<std::size_t> first(s.components, s.vertices());
    for (std::size_t v = s.vertices(); v-- > 0;) first[s.component[v]] = v;
    return first;
}

/// None where film runs out, as into a wide place; one for all vertices at one place.
std::vector<int> potential_unknowns(const Surface& s) {
    const std::vector<std::uint32_t> connected = connected_components(s);
    const auto films = [&](std::size_t v) { return connected[s.component[v]]; };
    std::vector<std::size_t> pinned = first_vertices(s);
    for (std::size_t v = 0; v < s.vertices(); ++v)
        if (s.lets_out(v)) pinned[films(v)] = s.vertices();
    return numbered(
        s, [&](std::size_t v) { return s.lets_out(v) || v == pinned[films(v)]; }, s.joint);
}

/// None on outer walls, one for all vertices of the wall around a hole; free where film runs out between walls, which
/// makes it run straight out.
std::vector<int> stream_unknowns(const Surface& s) {
    std::vector<std::size_t> pinned = first_vertices(s), speaker(s.loops.size(), s.vertices());
    for (const BoundaryLoop& loop : s.loops) pinned[loop.component] = s.vertices();
    for (std::size_t v = s.vertices(); v-- > 0;)
        if (s.loop[v] >= 0) speaker[static_cast<std::size_t>(s.loop[v])] = v;
    const auto hole = [&](std::size_t v) {
        return s.loop[v] >= 0 && !s.loops[static_cast<std::size_t>(s.loop[v])].outer;
    };
    std::vector<int> unknown = numbered(s, [&](std::size_t v) {
        if (s.loop[v] < 0) return v == pinned[s.component[v]];
        if (s.lets_out(v) && s.place[v] == Place::kInside) return false;
        return !hole(v) || v != speaker[static_cast<std::size_t>(s.loop[v])];
    });
    for (std::size_t v = 0; v < s.vertices(); ++v)
        if (hole(v)) unknown[v] = unknown[speaker[static_cast<std::size_t>(s.loop[v])]];
    return unknown;
}

}  // namespace

FlowSolver::Poisson::Poisson(const Surface& s, std::vector<int> unknown, Films films)
    : matrix(s, std::move(unknown)), factors(refactored(films)) {
    if (matrix.size() == 0) return;
    matrix.assemble(s, 1.0, {}, {});
    factors.analyze(matrix.matrix());
    factorize(s);
}

void FlowSolver::Poisson::factorize(const Surface& s) {
    if (matrix.size() == 0) return;
    matrix.assemble(s, 1.0, {}, {});
    if (!factors.factorize(matrix.matrix())) throw NumericalError("the film's Poisson equation is singular");
}

std::vector<double> FlowSolver::Poisson::solve(const Surface& s,
                                               const std::vector<double>& right,
                                               bool lagging,
                                               int& iterations) const {
    std::vector<double> x = matrix.sums(right);
    if (x.empty()) return matrix.spread(x);
    if (!lagging) {
        factors.solve(x);
        return matrix.spread(x);
    }
    const std::vector<double> b = x;
    factors.precondition(x);
    const auto apply = [&](const std::vector<double>& p, std::vector<double>& y) {
        std::vector<double> image(s.vertices(), 0.0);
        add_stiffness(s, 1.0, {}, matrix.spread(p), image);
        y = matrix.sums(image);
    };
    const auto precondition = [&](const std::vector<double>& p, std::vector<double>& y) {
        y = p;
        factors.precondition(y);
    };
    const auto done =
        linalg::preconditioned_conjugate_gradient(apply, precondition, b, x, kLaggingTolerance, kMostIterations);
    iterations = std::max(iterations, done.iterations);
    return matrix.spread(x);
}

FlowSolver::FlowSolver(const Surface& s, Films films)
    : stream_(s, stream_unknowns(s), films),
      potential_(s, potential_unknowns(s), films),
      lagging_(films == Films::kMoving) {}

void FlowSolver::factorize(const Surface& s) {
    stream_.factorize(s);
    potential_.factorize(s);
}

std::vector<double> FlowSolver::stream_function(const Surface& s,
                                                std::span<const double> circulation,
                                                std::span<const double> hole_circulation) const {
    std::vector<double> right(circulation.begin(), circulation.end());
    for (double& value : right) value = -value;
    // The integral of grad phi . grad Psi over the cells at a wall is that of -omega and of the flow along the wall.
    std::vector<std::uint8_t> met(s.loops.size(), 0);
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        if (s.loop[v] < 0 || met[static_cast<std::size_t>(s.loop[v])] != 0) continue;
        met[static_cast<std::size_t>(s.loop[v])] = 1;
        const auto l = static_cast<std::size_t>(s.loop[v]);
        if (!s.loops[l].outer) right[v] -= hole_circulation[l];
    }
    return stream_.solve(s, right, lagging_, iterations_);
}

std::vector<double> FlowSolver::potential(const Surface& s, std::span<const double> outflow) const {
    std::vector<double> right(outflow.begin(), outflow.end());
    for (double& value : right) value = -value;
    return potential_.solve(s, right, lagging_, iterations_);
}

namespace {

std::vector<int> all_vertices(const Surface& s) {
    std::vector<int> unknown(s.vertices());
    std::iota(unknown.begin(), unknown.end(), 0);
    return unknown;
}

}  // namespace

ShiftedStiffness::ShiftedStiffness(const Surface& s, Films films)
    : matrix_(s,
              numbered(
                  s, [](std::size_t) { return false; }, s.joint)),
      factors_(refactored(films)) {
    factors_.analyze(matrix_.matrix());
}

void ShiftedStiffness::factorize(const Surface& s,
                                 double scale,
                                 std::span<const double> weight,
                                 std::span<const double> mass) {
    matrix_.assemble(s, scale, weight, mass);
    if (!factors_.factorize(matrix_.matrix()))
        throw NumericalError("vortex_particle: a diffusion matrix of the film is singular");
}

namespace {

constexpr double kTie = 1.0 / 24.0;  // half of what the integrals of phi_i phi_j have

}  // namespace

Diffusion::Diffusion(const Surface& s, Films films) : matrix_(s, all_vertices(s)), factors_(refactored(films)) {
    factors_.analyze(matrix_.matrix());
}

void Diffusion::factorize(const Surface& s, double scale) {
    scale_ = scale;
    matrix_.assemble(s, scale, {}, s.vertex_area, kTie);
    if (!factors_.factorize(matrix_.matrix()))
        throw NumericalError("vortex_particle: the matrix of the film's viscosity is singular");
}

void Diffusion::spread(const Surface& s, std::vector<double>& cells) const {
    std::vector<double> density = cells;
    factors_.solve(density);
    add_stiffness(s, -scale_, {}, density, cells);
}

void Diffusion::spread_lagging(const Surface& s, double scale, std::vector<double>& cells) const {
    std::vector<double> density = cells;
    factors_.precondition(density);
    const auto apply = [&](const std::vector<double>& p, std::vector<double>& y) {
        y.resize(p.size());
        for (std::size_t v = 0; v < p.size(); ++v) y[v] = s.vertex_area[v] * p[v];
        add_ties(s, kTie, p, y);
        add_stiffness(s, scale, {}, p, y);
    };
    const auto precondition = [&](const std::vector<double>& p, std::vector<double>& y) {
        y = p;
        factors_.precondition(y);
    };
    linalg::preconditioned_conjugate_gradient(apply, precondition, cells, density, kLaggingTolerance, kMostIterations);
    add_stiffness(s, -scale, {}, density, cells);
}

}  // namespace lamella::vortex_particle
