#include "sheets.h"
#include "signal.h"
#include "lamella/solvers/vortex_sheet/step_limit.h"

#include "lamella/mesh/shapes/standard_clusters.h"

#include <gtest/gtest.h>
#include <ctime>
#include <cstdio>

namespace lamella::vortex_sheet {
namespace {

double cpu() { return double(std::clock()) / CLOCKS_PER_SEC; }

void run(double edge, double m, double theta, spatial::VortexKernel kernel, double length, bool implicit, double end) {
    mesh::FoamMesh sphere = mesh::spheres({{Vec3{}, 1.0}}, edge);
    for (Vec3& x : sphere.position) x *= 1.0 + 0.01 * legendre(2, x[0] / norm(x));
    sphere.regions[mesh::RegionId{1}].target_volume = mesh::region_volumes(sphere)[mesh::RegionId{1}];
    Options options;
    options.kernel = kernel; options.smoothing_length = length;
    options.remeshing = false;
    options.theta = theta; options.implicit_tolerance = std::getenv("TOL") ? std::atof(std::getenv("TOL")) : 1e-4;
    options.tension = implicit ? Tension::kImplicit : Tension::kExplicit;
    options.step_safety = 0.9;
    options.steps_per_period = 4.0;
    const double limit = capillary_step_limit(kernel, length, edge, 1.0, 1.0);
    options.largest_step = m * limit;
    auto solver = started(unit_problem(sphere, edge), options);
    std::vector<double> a{mode(solver->mesh(), 2)};
    int iterations = 0, steps = 0, most = 0; double volume = 0, e0 = scalar(*solver, "energy"), emin = e0, emax = e0, kin = 0;
    const double t0 = cpu();
    while (solver->time() < end) {
        const auto r = solver->advance(1e9);
        iterations += int(r.iterations); most = std::max(most, int(r.iterations)); ++steps;
        a.push_back(mode(solver->mesh(), 2));
        const double e = scalar(*solver, "energy"); emin = std::min(emin, e); emax = std::max(emax, e); kin = std::max(kin, scalar(*solver, "energy_kinetic"));
    }
    const double dt = solver->time() / steps;
    const Oscillation o = oscillation(a);
    std::printf("%zu v m %.1f theta %.2f dt %.4f steps %d iterations %.2f (most %d) evals/time %.1f omega %.5f amplitude %.5f -> %.5f energy spread/kin %.4f cpu %.1f\n",
                sphere.position.size(), m, theta, dt, steps, double(iterations) / steps, most, (double(iterations) / steps + 1) / dt, o.angle / dt, o.first, o.last, (emax - emin) / kin, cpu() - t0);
    (void)volume;
}


void cluster(double edge, double m, bool implicit, double end, bool remesh) {
    mesh::FoamMesh films = mesh::double_bubble(mesh::double_bubble_of_radii(1.0, 1.0), edge);
    std::printf("double %zu v\n", films.position.size());
    for (Vec3& x : films.position) x[0] *= 1.05;
    const auto volume = mesh::region_volumes(films);
    for (const mesh::RegionId r : films.regions.ids()) films.regions[r].target_volume = volume[r];
    Options options;
    options.kernel = spatial::VortexKernel::kK2; options.smoothing_length = 1.0;
    options.remeshing = remesh; options.implicit_tolerance = std::getenv("TOL") ? std::atof(std::getenv("TOL")) : 1e-4;
    options.tension = implicit ? Tension::kImplicit : Tension::kExplicit;
    options.step_safety = 0.9; options.steps_per_period = 4.0;
    options.largest_step = m * capillary_step_limit(options.kernel, 1.0, edge, 1.0, 1.0);
    auto solver = started(unit_problem(films, edge), options);
    const double e0 = scalar(*solver, "energy_surface"); double kin = 0, lo = 0, hi = 0; int it = 0, steps = 0, most = 0; const double t0 = cpu();
    std::vector<double> a;
    while (solver->time() < end) {
        const auto r = solver->advance(1e9); it += int(r.iterations); most = std::max(most, int(r.iterations)); ++steps;
        const double d = scalar(*solver, "energy") - e0; lo = std::min(lo, d); hi = std::max(hi, d); kin = std::max(kin, scalar(*solver, "energy_kinetic"));
    }
    std::printf("double m %.1f dt %.4f remesh %d steps %d it %.2f most %d kin %.4e energy %.3e..%.3e ended %.3e cpu %.1f\n", m, solver->time() / steps, remesh, steps, double(it) / steps, most, kin, lo, hi, scalar(*solver, "energy") - e0, cpu() - t0);
}

TEST(Implicit, Table) {
    const auto k2 = spatial::VortexKernel::kK2;
    for (double m : {2.0, 4.0, 8.0}) run(0.151, m, 0.5, k2, 1.0, true, 6.3);
    for (double m : {4.0, 8.0}) run(0.0755, m, 0.5, k2, 1.0, true, 4.2);
    cluster(0.2, 0.5, false, 4, false);
    for (double m : {2.0, 4.0, 8.0}) cluster(0.2, m, true, 4, false);
    cluster(0.2, 0.5, false, 4, true);
    for (double m : {2.0, 4.0, 8.0}) cluster(0.2, m, true, 4, true);
}

}  // namespace
}  // namespace lamella::vortex_sheet
