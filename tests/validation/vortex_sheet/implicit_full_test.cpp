// Semi-implicit steps follow the slow oscillations at steps that no explicit scheme survives, at the error of the midpoint
// rule and without damping.

#include "oscillation.h"
#include "sheets.h"
#include "signal.h"

#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/solvers/vortex_sheet/step_limit.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace lamella::vortex_sheet {
namespace {

constexpr auto kKernel = spatial::VortexKernel::kK2;

Options implicit_options(double edge, double multiple) {
    Options options;
    options.kernel = kKernel;
    options.smoothing_length = 1.0;
    options.remeshing = false;
    options.tension = Tension::kImplicit;
    options.steps_per_period = 4.0;
    options.implicit_tolerance = 1e-6;  // at the default, 1e-4, frequencies are off by up to 1.7 %
    options.sum_in_double = true;
    options.largest_step = multiple * capillary_step_limit(kKernel, 1.0, edge, 1.0, 1.0);
    return options;
}

struct Case {
    double edge, multiple;
    double iterations;  ///< per step, at most
};

TEST(Implicit, StepsFollowTheSphereAtTheErrorOfTheMidpointRule) {
    for (const Case& c : {Case{0.151, 2.0, 5.0}, Case{0.151, 4.0, 7.0}, Case{0.151, 8.0, 8.0}, Case{0.0755, 4.0, 6.0},
                          Case{0.0755, 8.0, 8.0}}) {
        mesh::FoamMesh sphere = mesh::spheres({{Vec3{}, 1.0}}, c.edge);
        for (Vec3& x : sphere.position) x *= 1.0 + 0.01 * legendre(2, x[0] / norm(x));
        sphere.regions[mesh::RegionId{1}].target_volume = mesh::region_volumes(sphere)[mesh::RegionId{1}];
        auto solver = started(unit_problem(sphere, c.edge), implicit_options(c.edge, c.multiple));
        std::vector<double> amplitude{mode(solver->mesh(), 2)};
        double iterations = 0.0;
        while (solver->time() < 6.3) {
            iterations += static_cast<double>(solver->advance(1e9).iterations);
            amplitude.push_back(mode(solver->mesh(), 2));
        }
        const auto steps = static_cast<double>(solver->step());
        const double dt = solver->time() / steps;
        const Oscillation o = oscillation(amplitude);
        const double exact = lamb(2) * predicted(kKernel, c.edge, 2);
        const double midpoint = 2.0 / dt * std::atan(0.5 * exact * dt);  // what the rule makes of it
        std::printf("edge %.4f, %.0f times the limit: omega %.4f, midpoint rule %.4f, exact %.4f; %.2f iterations; amplitude "
                    "%.5f to %.5f\n",
                    c.edge, c.multiple, o.angle / dt, midpoint, exact, iterations / steps, o.first, o.last);
        EXPECT_NEAR(o.angle / dt / midpoint, 1.0, 0.004);  // 0.2 % of it the error of the mesh
        EXPECT_NEAR(o.last / o.first, 1.0, 0.01);          // no damping over three periods
        EXPECT_LT(iterations / steps, c.iterations);
    }
}

TEST(Implicit, StepsKeepTheEnergyOfADoubleBubble) {
    constexpr double kEdge = 0.2;
    for (const double multiple : {2.0, 4.0, 8.0}) {
        mesh::FoamMesh films = mesh::double_bubble(mesh::double_bubble_of_radii(1.0, 1.0), kEdge);
        for (Vec3& x : films.position) x[0] *= 1.05;
        const auto volume = mesh::region_volumes(films);
        for (const mesh::RegionId r : films.regions.ids()) films.regions[r].target_volume = volume[r];
        auto solver = started(unit_problem(films, kEdge), implicit_options(kEdge, multiple));
        const double start = scalar(*solver, "energy");
        double worst = 0.0, kinetic = 0.0, iterations = 0.0;
        while (solver->time() < 4.0) {
            iterations += static_cast<double>(solver->advance(1e9).iterations);
            worst = std::max(worst, std::abs(scalar(*solver, "energy") - start));
            kinetic = std::max(kinetic, scalar(*solver, "energy_kinetic"));
        }
        const auto steps = static_cast<double>(solver->step());
        std::printf("double bubble, %.0f times the limit: energy off by %.3f of the kinetic, %.2f iterations\n", multiple,
                    worst / kinetic, iterations / steps);
        EXPECT_LT(worst, 0.03 * kinetic);
        EXPECT_LT(iterations / steps, 11.0);
    }
}

}  // namespace
}  // namespace lamella::vortex_sheet
