#include "lamella/solvers/melp/surfactant.h"

#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/operators.h"

namespace lamella::melp {

SurfactantStep solve_surfactant(const Geometry& geometry,
                                std::span<const Vec3> position,
                                const Films& films,
                                std::span<const Vec3> velocity,
                                const film::SurfactantLaw& law,
                                std::span<const double> inertia,
                                double dt,
                                double tolerance) {
    const Neighbors& same = geometry.neighbors.same;
    const std::size_t count = geometry.size();
    const auto beta = [&](std::size_t i) { return 2.0 * law.thermal_energy() / inertia[i]; };
    std::vector<double> coupling(same.index.size()), diagonal(count), right(count), scale(count);
    const std::vector<double> stretch = divergence(geometry, position, velocity);
    for_each_particle(count, [&](std::size_t i) {
        const double a = geometry.area[i];
        diagonal[i] = a / films.concentration[i];
        right[i] = a * (1.0 - dt * stretch[i]);
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
            const std::size_t j = same.index[k];
            const double mean = 2.0 * beta(i) * beta(j) / (beta(i) + beta(j));
            coupling[k] = dt * dt * (a * geometry.area[j]) * mean * same.laplacian[k];
            diagonal[i] += coupling[k];
        }
        scale[i] = 1.0 / diagonal[i];
    });
    const auto apply = [&](const std::vector<double>& x, std::vector<double>& y) {
        y.resize(count);
        for_each_particle(count, [&](std::size_t i) {
            double sum = diagonal[i] * x[i];
            for (std::size_t k = same.begin(i); k < same.end(i); ++k) sum -= coupling[k] * x[same.index[k]];
            y[i] = sum;
        });
    };
    SurfactantStep step{films.concentration, {}};
    constexpr int kMostIterations = 2000;
    step.solution = linalg::conjugate_gradient(apply, scale, right, step.concentration, tolerance, kMostIterations);
    return step;
}

}  // namespace lamella::melp
