#pragma once

// Taylor's pair of vortices and pairs that leapfrog [method sheet 12.2, 12.3].

#include "films.h"

#include <fmt/format.h>

#include <cmath>

namespace lamella::vortex_particle {

/// Two vortices of one sign, core 0.3, speed 1, in the middle of a square of side 2 pi.
inline std::unique_ptr<VortexParticleSolver> taylor_vortices(double distance,
                                                             int cells,
                                                             const std::vector<std::string>& overrides = {}) {
    constexpr double kPi = 3.14159265358979323846;
    return solver_of(fmt::format(R"(
[material]
kinematic_viscosity = 0.0
[[film]]
shape = "rectangle"
center = [{0}, {0}, 0]
u = [{1}, 0, 0]
v = [0, {1}, 0]
[[vortex]]
profile = "taylor"
center = [{2}, 0, 0]
radius = 0.3
speed = 1.0
[[vortex]]
profile = "taylor"
center = [{3}, 0, 0]
radius = 0.3
speed = 1.0
[resolution]
edge_length = {4}
[vortex_particle]
incompressible = true
)", -kPi, 2 * kPi, -0.5 * distance, 0.5 * distance, 2 * kPi / cells), overrides);
}

struct PairRun {
    double end;           ///< distance at the end
    double energy_error;  ///< largest relative change of the kinetic energy
};
inline PairRun run_pair(double distance, int cells, double until) {
    auto solver = taylor_vortices(distance, cells);
    solver->start({});
    const double energy = solver->kinetic_energy();
    Centers centers(*solver, {{{-0.5 * distance, 0, 0}}, {{0.5 * distance, 0, 0}}}, {1.0, 1.0}, 0.25);
    PairRun run{0.0, 0.0};
    while (solver->time() < until) {
        solver->advance(until);
        centers.follow();
        run.energy_error = std::max(run.energy_error, std::abs(solver->kinetic_energy() / energy - 1.0));
    }
    run.end = norm(centers[0] - centers[1]);
    return run;
}

/// Two vortices above and two of the other sign below, of equal strength, at heights 0.6 and 0.2.
inline std::unique_ptr<VortexParticleSolver> leapfrog(double core, double edge, double step) {
    std::string tables = fmt::format(R"(
[material]
kinematic_viscosity = 0.0
[[film]]
shape = "rectangle"
center = [-2, -1, 0]
u = [4, 0, 0]
v = [0, 2, 0]
[resolution]
edge_length = {}
[vortex_particle]
incompressible = true
largest_step = {}
)", edge, step);
    for (const double y : {0.6, 0.2, -0.2, -0.6})
        tables += fmt::format("[[vortex]]\ncenter = [-1.5, {}, 0]\nradius = {}\ncirculation = {}\n", y, core, y > 0 ? 1.0 : -1.0);
    return solver_of(tables);
}

/// When the upper two vortices change places: which of them is ahead.
inline std::vector<double> swaps(VortexParticleSolver& solver, double until) {
    solver.start({});
    Centers centers(solver, {{{-1.5, 0.6, 0}}, {{-1.5, 0.2, 0}}}, {1.0, 1.0}, 0.12);
    std::vector<double> times;
    double before = 0.0, lead = 0.0;
    while (solver.time() < until) {
        const double from = solver.time();
        solver.advance(until);
        centers.follow();
        const double now = centers[1][0] - centers[0][0];
        if (lead * now < 0.0) times.push_back(from + (solver.time() - from) * before / (before - now));
        if (lead * now < 0.0 || lead == 0.0) lead = now;
        before = now;
    }
    return times;
}

/// The same for point vortices: in the box, by images in its walls, with the fourth-order method of Runge and Kutta.
inline std::vector<double> point_swaps(double until) {
    using State = std::array<std::array<double, 2>, 4>;
    constexpr double kTwoPi = 6.283185307179586;
    constexpr std::array<double, 4> kSign{1.0, 1.0, -1.0, -1.0};
    const auto rate = [&](const State& z) {
        State u{};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                for (int m = -4; m <= 4; ++m)
                    for (int n = -4; n <= 4; ++n) {
                        if (i == j && m == 0 && n == 0) continue;
                        const double x = (m % 2 == 0 ? z[j][0] : -z[j][0]) + 4.0 * m;
                        const double y = (n % 2 == 0 ? z[j][1] : -z[j][1]) + 2.0 * n;
                        const double s = kSign[j] * ((m + n) % 2 == 0 ? 1.0 : -1.0) / kTwoPi;
                        const double dx = z[i][0] - x, dy = z[i][1] - y, r2 = dx * dx + dy * dy;
                        u[i][0] -= s * dy / r2;
                        u[i][1] += s * dx / r2;
                    }
        return u;
    };
    const auto ahead = [](State z, const State& u, double h) {
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 2; ++k) z[i][k] += h * u[i][k];
        return z;
    };
    State z{{{-1.5, 0.6}, {-1.5, 0.2}, {-1.5, -0.2}, {-1.5, -0.6}}};
    constexpr double kStep = 0.02;
    std::vector<double> times;
    double before = 0.0;
    for (double t = 0.0; t < until; t += kStep) {
        const State a = rate(z), b = rate(ahead(z, a, 0.5 * kStep)), c = rate(ahead(z, b, 0.5 * kStep)), d = rate(ahead(z, c, kStep));
        for (const auto& [u, weight] : {std::pair{&a, 1.0}, {&b, 2.0}, {&c, 2.0}, {&d, 1.0}}) z = ahead(z, *u, weight * kStep / 6.0);
        const double now = z[1][0] - z[0][0];
        if (before * now < 0.0) times.push_back(t + kStep * before / (before - now));
        before = now;
    }
    return times;
}

}  // namespace lamella::vortex_particle
