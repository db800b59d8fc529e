// How long steps may be, and how far they are implicit.

#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/melp/operators.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lamella::melp {

/// Particles move by less than cfl spacings, and swings and falls are resolved.
double MelpSolver::choose_step(double time_limit) const {
    double fastest = fastest_edge();
    for (const Vec3& u : coarse_.velocity) fastest = std::max(fastest, norm(u));
    for (const Vec3& u : fine_.velocity) fastest = std::max(fastest, norm(u));
    fastest = std::max({fastest, rims_.fastest(), film::fastest(input_.films->solids)});
    for (const film::Body& body : bodies_)
        if (body.free) fastest = std::max(fastest, norm(body.velocity));
    const double farthest = options_.cfl * spacing_, pull = strongest_pull();
    double dt = options_.largest_step > 0.0 ? options_.largest_step : std::numeric_limits<double>::infinity();
    if (fastest > 0.0) dt = std::min(dt, farthest / fastest);
    if (pull > 0.0) dt = std::min(dt, std::sqrt(2.0 * farthest / pull));
    for (const film::Body& body : bodies_) {
        constexpr double kOfSwing =
            0.2;  // of the time that a solid needs at least for a radian of swinging on its film
        const double tension = input_.films->material.film_tension();
        if (body.free) dt = std::min(dt, kOfSwing * std::sqrt(body.mass / (2.0 * std::numbers::pi * tension)));
    }
    if (options_.steps_per_period > 0.0) dt = std::min(dt, slowest_period(gas_) / options_.steps_per_period);
    const double left = time_limit - time_;
    if (left <= dt) return left;
    return left < 2.0 * dt ? 0.5 * left : dt;  // no crumb of a step before an output
}

/// A step in which films have come to move as far as planned: tension that nothing balances, where films have just
/// joined or burst, shows only in the velocities after it. The same step where they do not move much farther already.
double MelpSolver::shorter_step(double dt) const {
    constexpr double kMuchFarther = 2.0, kShortest = 0.2;
    double fastest = 0.0;
    for (const Vec3& u : coarse_.velocity) fastest = std::max(fastest, norm(u));
    const double planned = options_.cfl * spacing_;
    return fastest * dt <= kMuchFarther * planned ? dt : dt * std::max(planned / (fastest * dt), kShortest);
}

/// Largest acceleration by gravity and surfactant now [m/s^2]: liquid at rest may have it all before it.
double MelpSolver::strongest_pull() const {
    const std::vector<Vec3> pull = surfactant_pull(films_.pressing);
    const std::vector<Vec3> beside = other_pull();
    double strongest = 0.0;
    for (std::size_t i = 0; i < coarse_.size(); ++i)
        strongest =
            std::max(strongest, norm(weight_at(i) + (pull[i] + beside[i]) / (liquid_density() * films_.thickness[i])));
    return strongest;
}

/// Swings that steps of this length do not resolve would ring from step to step with theta = 1/2: they are damped. So
/// is everything while bubbles touch: forces at a junction are not those of the matrix to second order, and theta = 1/2
/// blew two bubbles up that met without damping.
double MelpSolver::theta_of(double dt) const {
    constexpr double kResolved = 10.0;  // steps per period
    const bool apart = geometry_.neighbors.other.index.empty() && !any_burst();
    return apart && kResolved * dt < slowest_period(gas_) ? options_.theta : 1.0;
}

/// Of mode 2 of the smallest bubble, or of the first mode of a disk as large as the smallest film on wires, in an empty
/// space but for air_mass. [method sheet 14, V7]
double MelpSolver::slowest_period(const std::vector<Gas>& bubbles) const {
    const film::Material& material = input_.films->material;
    double shortest = std::numeric_limits<double>::infinity();
    for (const Gas& gas : bubbles) {
        if (gas.gone) continue;
        const double radius = gas.radius();
        const double mass = liquid_density() * material.thickness + options_.air_mass * material.air_density * radius;
        constexpr double kDrum = 2.404825557695773;  // first zero of the Bessel function J_0
        const double wave = gas.closed ? std::numbers::pi : 2.0 * std::numbers::pi / kDrum;
        shortest = std::min(shortest, wave * radius * std::sqrt(mass / material.film_tension()));
    }
    return shortest;
}

}  // namespace lamella::melp
