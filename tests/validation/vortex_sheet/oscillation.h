#pragma once

// A bubble that swings in one mode: what its frequency is to be, and what it is.

#include "sheets.h"

namespace lamella::vortex_sheet {

/// sqrt of (omega^2 of mode l over Lamb's) for kernel of length delta on the unit sphere [method sheet 6.2, 6.3].
inline double predicted(spatial::VortexKernel kernel, double delta, int l) {
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

inline double lamb(int l) { return std::sqrt(2.0 * (l - 1) * l * (l + 1) * (l + 2) / (2 * l + 1)); }

/// Time of a swing of `value`, which vanishes at rest: over the first five crossings of zero.
template <class Value>
double period(VortexSheetSolver& solver, Value&& value) {
    double before = value(), first = 0.0, last = 0.0;
    for (int crossings = 0; crossings < 5 && solver.time() < 20.0;) {
        const double time = solver.time();
        solver.advance(1e9);
        const double now = value();
        if (now * before < 0.0) {
            last = time + (solver.time() - time) * before / (before - now);
            if (crossings++ == 0) first = last;
        }
        before = now;
    }
    return (last - first) / 2.0;
}

/// Frequency of a bubble of radius 1 that starts in mode l with amplitude 0.01.
inline double frequency(double edge, int l, const Options& options, std::size_t* vertices = nullptr) {
    mesh::FoamMesh sphere = mesh::spheres({{Vec3{}, 1.0}}, edge);
    for (Vec3& x : sphere.position) x *= 1.0 + 0.01 * legendre(l, x[0] / norm(x));
    sphere.regions[mesh::RegionId{1}].target_volume = mesh::region_volumes(sphere)[mesh::RegionId{1}];
    if (vertices != nullptr) *vertices = sphere.position.size();
    const auto solver = started(unit_problem(sphere, edge), options);
    return 2.0 * 3.14159265358979323846 / period(*solver, [&] { return mode(solver->mesh(), l); });
}

/// The options of these tests: nothing but the sheet and its triangles.
inline Options plain(spatial::VortexKernel kernel) {
    Options options;
    options.kernel = kernel;
    options.smoothing_length = 1.0;
    options.remeshing = false;
    options.step_safety = 0.3;
    return options;
}

/// Error of the curvature and of the averages at vertices, which no kernel takes away: second order in the triangles
/// over the wave length. Measured: 0.012, 0.052 and 0.066 (l h / R)^2 for l = 2, 3, 4.
inline double mesh_error(int l, double edge) { return 0.08 * (l * edge) * (l * edge); }

}  // namespace lamella::vortex_sheet
