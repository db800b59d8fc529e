#include "lamella/solvers/melp/exchange.h"

#include "lamella/solvers/melp/loops.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {
namespace {

/// Film of other regions that faces a particle: 1 where two even films coincide.
std::vector<double> facing_film(const Geometry& g) {
    const Neighbors& other = g.neighbors.other;
    std::vector<double> gamma(g.size(), 0.0);
    for_each_particle(g.size(), [&](std::size_t i) {
        for (std::size_t k = other.begin(i); k < other.end(i); ++k)
            if (dot(g.normal[i], g.normal[other.index[k]]) < 0.0) gamma[i] += g.area[other.index[k]] * other.weight[k];
    });
    return gamma;
}

}  // namespace

Exchange exchange_between(const Geometry& g,
                          const Films& films,
                          std::span<const Vec3> velocity,
                          std::span<const double> joined,
                          double rate,
                          double dt) {
    const Neighbors& other = g.neighbors.other;
    const std::vector<double> gamma = facing_film(g);
    const auto has_none = [&](std::size_t i) { return films.dry[i] != 0 || films.concentration[i] <= 0.0; };
    const double share = -0.5 * std::expm1(-rate * dt);
    Exchange gained{std::vector<double>(g.size(), 0.0), std::vector<double>(g.size(), 0.0), std::vector<Vec3>(g.size()),
                    std::vector<double>(g.size(), 0.0)};
    for_each_particle(g.size(), [&](std::size_t i) {
        if (has_none(i)) return;
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
            const std::size_t j = other.index[k];
            if (has_none(j) || dot(g.normal[i], g.normal[j]) >= 0.0) continue;
            const double part = share / std::max({1.0, gamma[i], gamma[j]}) * (joined.empty() ? 1.0 : joined[k]);
            const double c = part * (g.area[i] * g.area[j]) * other.weight[k];
            gained.liquid_volume[i] += c * (films.thickness[j] - films.thickness[i]);
            gained.surfactant[i] += c * (films.concentration[j] - films.concentration[i]);
            gained.momentum[i] += c * (films.thickness[j] * velocity[j] - films.thickness[i] * velocity[i]);
            gained.heat[i] +=
                c * (films.thickness[j] * films.temperature[j] - films.thickness[i] * films.temperature[i]);
        }
    });
    return gained;
}

}  // namespace lamella::melp
