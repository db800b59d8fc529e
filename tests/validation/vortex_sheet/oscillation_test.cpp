// A bubble oscillates at Lamb's frequency [Lamb32, art. 275], times the exact factor of the smoothed kernel.

#include "sheets.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace lamella::vortex_sheet {
namespace {

/// sqrt of (omega^2 of mode l over Lamb's) for kernel of length delta on the unit sphere [sheet 6.2, 6.3].
double predicted(spatial::VortexKernel kernel, double delta, int l) {
    const auto response = [l](double d) {
        const double t = 1.0 + 0.5 * d * d - d * std::sqrt(1.0 + 0.25 * d * d);
        return std::pow(t, l + 0.5);
    };
    const double e = 1e-3;
    const double first = (response(delta + e) - response(delta - e)) / (2 * e);
    const double second = (response(delta + e) - 2 * response(delta) + response(delta - e)) / (e * e);
    double factor = response(delta);
    if (kernel != spatial::VortexKernel::kPlummer) factor -= delta * first;
    if (kernel == spatial::VortexKernel::kK3) factor += 0.5 * delta * delta * second;
    return std::sqrt(factor);
}

double lamb(int l) { return std::sqrt(2.0 * (l - 1) * l * (l + 1) * (l + 2) / (2 * l + 1)); }

/// Frequency from the crossings of zero of a mode that starts with amplitude 0.01.
double frequency(double edge, int l, const Options& options, std::size_t* vertices = nullptr) {
    mesh::FoamMesh sphere = mesh::spheres({{Vec3{}, 1.0}}, edge);
    for (Vec3& x : sphere.position) x *= 1.0 + 0.01 * legendre(l, x[0] / norm(x));
    sphere.regions[mesh::RegionId{1}].target_volume = mesh::region_volumes(sphere)[mesh::RegionId{1}];
    if (vertices != nullptr) *vertices = sphere.position.size();
    auto solver = started(unit_problem(sphere, edge), options);
    double before = mode(solver->mesh(), l), last = 0.0;
    int crossings = 0;
    double first_crossing = 0.0, last_crossing = 0.0;
    while (crossings < 5) {
        last = solver->time();
        solver->advance(1e9);
        const double now = mode(solver->mesh(), l);
        if (now * before < 0.0) {
            const double at = last + (solver->time() - last) * before / (before - now);
            (crossings == 0 ? first_crossing : last_crossing) = at;
            ++crossings;
        }
        before = now;
        if (solver->time() > 20.0) break;
    }
    return 4.0 * 3.14159265358979323846 / (last_crossing - first_crossing);
}

TEST(Oscillation, HasLambsFrequencyTimesTheFactorOfTheKernel) {
    for (const double edge : {0.151, 0.0755})
        for (const int l : {2, 3, 4})
            for (const auto kernel : {spatial::VortexKernel::kPlummer, spatial::VortexKernel::kK2, spatial::VortexKernel::kK3}) {
                Options options;
                options.kernel = kernel;
                options.smoothing_length = 1.0;
                options.remeshing = false;
                options.step_safety = 0.3;
                std::size_t vertices = 0;
                const double omega = frequency(edge, l, options, &vertices);
                std::printf("%zu vertices l %d kernel %d: omega/Lamb %.4f predicted %.4f\n", vertices, l,
                            static_cast<int>(kernel), omega / lamb(l), predicted(kernel, edge, l));
            }
}

}  // namespace
}  // namespace lamella::vortex_sheet
