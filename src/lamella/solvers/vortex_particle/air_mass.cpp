#include "lamella/solvers/vortex_particle/air_mass.h"

#include "lamella/core/error.h"

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
    const double longest = 4.0 * pi / part;                      // L of the longest waves, about
    const double shortest = 40.0 / (s.mean_edge * s.mean_edge);  // of the shortest
    const double low = std::log(curved > 1e-3 * longest ? 0.25 * curved : longest) - kBelow;
    const double quarter = curved > 1e-3 * longest ? 0.25 * curved : 0.0;
    const int count = static_cast<int>(std::ceil((std::log(shortest) + kAbove - low) / kStep));
    area_ = s.vertex_area;
    for (double& part_area : closed_) part_area = part_area > 0.0 ? 1e-300 : 0.0;
    for (std::size_t v = 0; v < area_.size(); ++v)
        if (closed_[component_[v]] > 0.0) closed_[component_[v]] += area_[v];
    terms_.clear();
    const auto add_term = [&](double weight, double shift) {
        std::vector<double> mass = s.vertex_area;
        for (double& m : mass) m *= shift;
        matrix_.assemble(s, 1.0, {}, mass);
        Term& term = terms_.emplace_back(Term{weight, linalg::DefiniteSolver(linalg::Refactored::kSeldom)});
        term.factors.analyze(matrix_.matrix());
        if (!term.factors.factorize(matrix_.matrix()))
            throw NumericalError("vortex_particle: the air's matrix is singular");
    };
    // What lies below the lowest of the sum acts as 1 / L, which a small shift makes regular.
    const double first = std::exp(low - 0.5 * kStep);
    add_term(std::sqrt(4.0 * quarter) + (quarter > 0.0 ? 0.0 : 4.0 / pi * std::sqrt(first)), kShift * longest);
    for (int j = 0; j <= count; ++j) {
        const double e = std::exp(low + kStep * j), shift = quarter + e;
        add_term(kStep / pi * 2.0 * e * std::sqrt(e) / shift, shift);
    }
    constant_ = 4.0 / pi / std::exp(0.5 * (low + kStep * (count + 0.5)));
    middle_ = 2.0 * density_ / std::pow(longest * shortest, 0.25);
}

/// Takes from values per vertex, each with its vertex's area in it, the mean of each closed film.
void AirMass::remove_mean(std::vector<double>& density) const {
    std::vector<double> mean(closed_.size(), 0.0);
    for (std::size_t v = 0; v < density.size(); ++v) mean[component_[v]] += density[v];
    for (std::size_t c = 0; c < mean.size(); ++c) mean[c] = closed_[c] > 0.0 ? mean[c] / closed_[c] : 0.0;
    for (std::size_t v = 0; v < density.size(); ++v) density[v] -= mean[component_[v]] * area_[v];
}

void AirMass::add(std::span<const double> speed, std::span<double> momentum) const {
    std::vector<double> given(speed.size()), sum(speed.size()), x(matrix_.size());
    for (std::size_t v = 0; v < speed.size(); ++v) given[v] = area_[v] * speed[v];
    std::vector<double> even = given;
    remove_mean(even);
    for (std::size_t j = 0; j < terms_.size(); ++j) {
        const std::vector<double>& right = j == 0 ? even : given;
        for (std::size_t v = 0; v < speed.size(); ++v)
            if (matrix_.unknown(v) >= 0) x[static_cast<std::size_t>(matrix_.unknown(v))] = right[v];
        terms_[j].factors.solve(x);
        for (std::size_t v = 0; v < speed.size(); ++v)
            if (matrix_.unknown(v) >= 0)
                sum[v] += terms_[j].weight * area_[v] * x[static_cast<std::size_t>(matrix_.unknown(v))];
        if (j == 0) remove_mean(sum);
    }
    for (std::size_t v = 0; v < speed.size(); ++v)
        if (matrix_.unknown(v) >= 0) momentum[v] += density_ * (constant_ * given[v] + sum[v]);
}

}  // namespace lamella::vortex_particle
