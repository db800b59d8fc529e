#include "lamella/solvers/vortex_particle/balance.h"

#include "lamella/core/parallel.h"

#include <vector>

namespace lamella::vortex_particle {
namespace {

std::uint32_t component_of(const Surface& s, std::size_t t) { return s.component[s.corner[t][0]]; }

/// Of a column of the particles, per component of the film.
std::vector<double> component_sums(const Surface& s, const Bins& bins, const std::vector<double>& column) {
    std::vector<double> in_triangle(s.triangles(), 0.0), sum(s.components, 0.0);
    parallel_for(s.triangles(), [&](std::size_t t) {
        for (std::size_t p = bins[t]; p < bins[t + 1]; ++p) in_triangle[t] += column[p];
    });
    for (std::size_t t = 0; t < s.triangles(); ++t) sum[component_of(s, t)] += in_triangle[t];
    return sum;
}

}  // namespace

void balance_circulation(const Surface& s, const Bins& bins, Particles& particles) {
    std::vector<double> density = component_sums(s, bins, particles.circulation);
    const std::vector<double> area = component_sums(s, bins, particles.area);
    for (std::size_t c = 0; c < density.size(); ++c) density[c] /= area[c];
    for (const BoundaryLoop& loop : s.loops) density[loop.component] = 0.0;
    parallel_for(particles.size(), [&](std::size_t p) {
        particles.circulation[p] -= density[component_of(s, particles.triangle[p])] * particles.area[p];
    });
}

void balance_area(const Surface& s, const Bins& bins, Particles& particles) {
    std::vector<double> factor(s.components, 0.0);
    for (std::size_t t = 0; t < s.triangles(); ++t) factor[component_of(s, t)] += s.area[t];
    const std::vector<double> area = component_sums(s, bins, particles.area);
    for (std::size_t c = 0; c < factor.size(); ++c) factor[c] /= area[c];
    parallel_for(particles.size(), [&](std::size_t p) {
        particles.area[p] *= factor[component_of(s, particles.triangle[p])];
    });
}

}  // namespace lamella::vortex_particle
