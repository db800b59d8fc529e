#include "lamella/solvers/vortex_particle/air_mass.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/linalg/dense.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::vortex_particle {
namespace {

std::vector<int> moving_vertices(const std::vector<std::uint8_t>& still) {
    std::vector<int> unknown(still.size(), -1);
    int next = 0;
    for (std::size_t v = 0; v < still.size(); ++v)
        if (still[v] == 0) unknown[v] = next++;
    return unknown;
}

/// The mean Gaussian curvature of all films, not below zero [1/m^2].
double mean_curvature_squared(const Surface& s) {
    const std::vector<double> curvature = gaussian_curvature(s);
    double sum = 0.0;
    for (std::size_t t = 0; t < s.triangles(); ++t) sum += curvature[t] * s.area[t];
    return std::max(0.0, sum / s.total_area);
}

}  // namespace

AirMass::AirMass(const Surface& s, double density, const std::vector<std::uint8_t>& still)
    : density_(density), matrix_(s, moving_vertices(still)), component_(s.component), closed_(s.components, 1.0) {
    for (std::size_t v = 0; v < still.size(); ++v)
        if (still[v] != 0) closed_[component_[v]] = 0.0;
}

void AirMass::factorize(const Surface& s) {
    using std::numbers::pi;
    constexpr double kStep = 2.0, kBelow = 5.0, kAbove = 2.0, kShift = 1e-3;
    double part = s.total_area;  // of the largest film, about
    if (s.components > 1) part /= s.components;
    const double curved = mean_curvature_squared(s);
    const double longest = longest_ = 4.0 * pi / part, shortest = shortest_ = 40.0 / (s.mean_edge * s.mean_edge);
    const double low = std::log(curved > 1e-3 * longest ? 0.25 * curved : longest) - kBelow;
    const double quarter = curved > 1e-3 * longest ? 0.25 * curved : 0.0;
    const int count = static_cast<int>(std::ceil((std::log(shortest) + kAbove - low) / kStep));
    area_ = s.vertex_area;
    for (double& part_area : closed_) part_area = part_area > 0.0 ? 1e-300 : 0.0;
    for (std::size_t v = 0; v < area_.size(); ++v)
        if (closed_[component_[v]] > 0.0) closed_[component_[v]] += area_[v];
    std::vector<double> shift;
    std::vector<double> weight;
    // What lies below the lowest of the sum acts as 1 / L, which a small shift makes regular.
    const double first = std::exp(low - 0.5 * kStep);
    weight.push_back(std::sqrt(4.0 * quarter) + (quarter > 0.0 ? 0.0 : 4.0 / pi * std::sqrt(first)));
    shift.push_back(kShift * longest);
    for (int j = 0; j <= count; ++j) {
        const double e = std::exp(low + kStep * j);
        shift.push_back(quarter + e);
        weight.push_back(kStep / pi * 2.0 * e * std::sqrt(e) / shift.back());
    }
    factor(s, shift, weight);
    constant_ = 4.0 / pi / std::exp(0.5 * (low + kStep * (count + 0.5)));
}

/// The equations with these shifts, all at once.
void AirMass::factor(const Surface& s, const std::vector<double>& shift, const std::vector<double>& weight) {
    terms_.clear();
    for (std::size_t j = 0; j < weight.size(); ++j)
        terms_.push_back({weight[j], shift[j], 0.0, linalg::DefiniteSolver(linalg::DefiniteMethod::kFactors)});
    std::vector<std::uint8_t> done(terms_.size(), 0);
    parallel_blocks(terms_.size(), 1, [&](std::size_t j, std::size_t) {
        std::vector<double> mass = s.vertex_area;
        for (double& m : mass) m *= shift[j];
        VertexMatrix matrix = matrix_;
        matrix.assemble(s, 1.0, {}, mass);
        terms_[j].factors.analyze(matrix.matrix());
        done[j] = terms_[j].factors.factorize(matrix.matrix()) ? 1 : 0;
    });
    if (std::find(done.begin(), done.end(), 0) != done.end())
        throw NumericalError("vortex_particle: the air's matrix is singular");
}

/// Takes from values per vertex, each with its vertex's area in it, the mean of each closed film.
void AirMass::remove_mean(std::vector<double>& density) const {
    std::vector<double> mean(closed_.size(), 0.0);
    for (std::size_t v = 0; v < density.size(); ++v) mean[component_[v]] += density[v];
    for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = closed_[c] > 0.0 ? mean[c] / closed_[c] : 0.0;
    for (std::size_t v = 0; v < density.size(); ++v) density[v] -= mean[component_[v]] * area_[v];
}

/// (L + s_j)^-1 of values that have their vertices' areas in them, for each term; the first without the mean.
std::vector<std::vector<double>> AirMass::solutions(std::span<const double> right) const {
    std::vector<double> even(right.begin(), right.end());
    remove_mean(even);
    std::vector<std::vector<double>> at_vertices(terms_.size());
    parallel_blocks(terms_.size(), 1, [&](std::size_t j, std::size_t) {
        std::vector<double> x = matrix_.sums(j == 0 ? std::span<const double>(even) : right);
        terms_[j].factors.solve(x);
        at_vertices[j] = matrix_.spread(x);
    });
    std::vector<double>& first = at_vertices[0];
    for (std::size_t v = 0; v < first.size(); ++v) first[v] *= area_[v];
    remove_mean(first);
    for (std::size_t v = 0; v < first.size(); ++v) first[v] /= area_[v];
    return at_vertices;
}

void AirMass::add(std::span<const double> speed, std::span<double> momentum) const {
    std::vector<double> given(speed.size());
    for (std::size_t v = 0; v < speed.size(); ++v) given[v] = area_[v] * speed[v];
    const std::vector<std::vector<double>> part = solutions(given);
    parallel_for(speed.size(), [&](std::size_t v) {
        if (matrix_.unknown(v) < 0) return;
        double sum = constant_ * speed[v];
        for (std::size_t j = 0; j < terms_.size(); ++j) sum += terms_[j].weight * part[j][v];
        momentum[v] += density_ * area_[v] * sum;
    });
}

/// Least squares of what the sum of the inverse terms is at waves of all lengths over what it should be.
void AirMass::fit_inverse(double mass, double stiffness) {
    constexpr double kPerWave = 1.3;  // ratio of neighboring L
    const std::size_t n = terms_.size();
    std::vector<double> square(n * n, 0.0), right(n, 0.0), row(n);
    for (double wave = 0.2 * longest_; wave < 2.0 * shortest_; wave *= kPerWave) {
        double inertia = mass + density_ * constant_ + stiffness * wave;
        for (const Term& term : terms_) inertia += density_ * term.weight / (wave + term.shift);
        for (std::size_t j = 0; j < n; ++j) row[j] = inertia / (wave + terms_[j].shift);
        for (std::size_t i = 0; i < n; ++i) {
            right[i] += row[i];
            for (std::size_t j = 0; j < n; ++j) square[n * i + j] += row[i] * row[j];
        }
    }
    // Terms of large shifts are small everywhere: each counts in units of its own.
    constexpr double kCutoff = 1e-11;
    std::vector<double> size(n);
    for (std::size_t j = 0; j < n; ++j) size[j] = std::sqrt(square[n * j + j]);
    for (std::size_t i = 0; i < n; ++i) {
        right[i] /= size[i];
        for (std::size_t j = 0; j < n; ++j) square[n * i + j] /= size[i] * size[j];
    }
    const std::vector<double> x = linalg::solve_symmetric(n, square, right, kCutoff).x;
    for (std::size_t j = 0; j < n; ++j) terms_[j].inverse = x[j] / size[j];
}

void AirMass::yield(std::span<const double> momentum, std::span<double> speed) const {
    const std::vector<std::vector<double>> part = solutions(momentum);
    parallel_for(speed.size(), [&](std::size_t v) {
        speed[v] = 0.0;
        for (std::size_t j = 0; j < terms_.size(); ++j) speed[v] += terms_[j].inverse * part[j][v];
    });
}

}  // namespace lamella::vortex_particle
