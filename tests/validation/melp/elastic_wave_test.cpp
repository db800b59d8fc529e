// Waves of thickness along the film: surfactant that is carried together pushes itself apart. [method sheet 14: V10]

#include <gtest/gtest.h>

#include "../../unit/melp/bubbles.h"

namespace lamella::melp {
namespace {

/// Amplitude of a mode of the thickness [m].
double thickness_mode(const MelpSolver& solver, int l) {
    double sum = 0.0, area = 0.0;
    for (std::size_t i = 0; i < solver.coarse().size(); ++i) {
        const Vec3& x = solver.coarse().position[i];
        sum += solver.geometry().area[i] * solver.films().thickness[i] * legendre(l, x[0] / norm(x));
        area += solver.geometry().area[i];
    }
    return (2 * l + 1) * sum / area;
}

TEST(ElasticWave, RunsAtTheSpeedOfMarangoni) {
    constexpr int kMode = 2;
    const double speed = std::sqrt(2.0 * 8.31446261815324 * 298.15 * 1e-7 / (1000.0 * 5e-7));
    const double exact = 2.0 * std::numbers::pi * kRadius / (speed * std::sqrt(kMode * (kMode + 1.0)));
    const std::string options = "largest_step = " + std::to_string(exact / 100.0) + "\nsteps_per_period = 20.0";
    auto solver = bubble(2562, options);
    test::StateMemory state = state_of(*solver);
    auto& position = state.reals["fine/position"];
    for (std::size_t p = 0; p < solver->fine().size(); ++p) {
        const Vec3 x{{position[3 * p], position[3 * p + 1], position[3 * p + 2]}};
        const double factor = 1.0 + 0.05 * legendre(kMode, x[0] / norm(x));
        state.reals["fine/liquid_volume"][p] *= factor;
        state.reals["fine/surfactant"][p] *= factor;
    }
    solver->load(state);
    const double swing = period(*solver, 2, [&] { return thickness_mode(*solver, kMode); });
    std::printf("period %.4f of the exact %.4f s\n", swing / exact, exact);
    EXPECT_NEAR(exact / swing, 1.0, 0.02);
}

}  // namespace
}  // namespace lamella::melp
