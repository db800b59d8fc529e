// The street of vortices behind a disk in a stream [method sheet 12.4]: minutes.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "films.h"
#include <algorithm>
#include <vector>

namespace lamella::vortex_particle {
namespace {

struct Street {
    double strouhal = 0.0;
    double drag = 0.0;  ///< coefficient
    int periods = 0;
};

/// A disk of diameter 1 in a stream of speed 1 and width 24. A vortex beside it starts the street, which has settled by
/// the time 24.
Street street(double reynolds, double edge, double end) {
    constexpr double kSettled = 24.0, kDynamicPressure = 0.5 * 1000.0 * 4e-7;  // times unit length
    auto solver = solver_of(fmt::format(R"(
[material]
kinematic_viscosity = {}
[[film]]
shape = "rectangle"
center = [-12, -12, 0]
u = [32, 0, 0]
v = [0, 24, 0]
focus = [1, 0, 0]
focus_radius = 1.6
focus_edge = {}
[[solid]]
center = [0, 0.01, 0]
radius = 0.5
[[vortex]]
center = [1.5, 0.5, 0]
radius = 0.3
circulation = 1.0
[resolution]
edge_length = 0.5
[vortex_particle]
incompressible = true
particles_per_triangle = 3
largest_step = 0.05
[vortex_particle.stream]
velocity = [1, 0, 0]
)",
                                        1.0 / reynolds, edge));
    solver->start({});
    Street found;
    int steps = 0;
    double first = 0.0, last = 0.0, time = 0.0, lift = 0.0;
    while (solver->time() < end) {
        solver->advance(end);
        const Vec3& force = solver->bodies()[0].force;
        // The force of one step is noisy; a twentieth of a period smooths it, and delays all crossings alike.
        const double before = lift, then = time;
        time = solver->time();
        lift += (force[1] - lift) * std::min(1.0, (time - then) / 0.25);
        if (time < kSettled) continue;
        ++steps;
        found.drag += force[0] / kDynamicPressure;
        if (before >= 0.0 || lift < 0.0) continue;
        const double at = then + (time - then) * before / (before - lift);
        (found.periods++ == 0 ? first : last) = at;
    }
    --found.periods;
    found.strouhal = found.periods / (last - first);
    found.drag /= steps;
    return found;
}

/// Strouhal numbers of experiments and of flows in two dimensions by other methods [method sheet 12.4].
class StreetBehindADisk : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(StreetBehindADisk, ShedsVorticesAsOftenAsMeasured) {
    const auto& [reynolds, strouhal] = GetParam();
    const Street found = street(reynolds, 0.05, 48.0);
    EXPECT_GE(found.periods, 3);
    EXPECT_NEAR(found.strouhal / strouhal, 1.0, 0.08) << found.strouhal << " drag " << found.drag;
    fmt::print("Re {}: Strouhal number {:.4f} over {} periods, drag coefficient {:.3f}\n", reynolds, found.strouhal,
               found.periods, found.drag);
}

INSTANTIATE_TEST_SUITE_P(Reynolds,
                         StreetBehindADisk,
                         testing::Values(std::pair{100.0, 0.164}, std::pair{150.0, 0.18}, std::pair{200.0, 0.19}));

}  // namespace
}  // namespace lamella::vortex_particle
