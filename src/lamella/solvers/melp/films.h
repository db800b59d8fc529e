#pragma once

#include "lamella/film/surfactant.h"
#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/heat.h"
#include "lamella/solvers/melp/transfer.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella::melp {

/// Liquid and surfactant of a region whose films have no fine particles: spread evenly, the tension the material's.
struct EvenFilm {
    double liquid_volume = 0.0;  ///< of the whole region [m^3]; 0: the region has fine particles
    double surfactant = 0.0;     ///< [mol]
    bool held = false;           ///< by rims: it does not fly
};

/// The film at coarse particles as the fine ones make it; one entry per coarse particle.
struct Films {
    std::vector<double> liquid_volume;   ///< [m^3]
    std::vector<double> thickness;       ///< [m]
    std::vector<double> seen_thickness;  ///< the fine particles' own, averaged [m]
    std::vector<double> concentration;   ///< of surfactant, per interface [mol/m^2]
    std::vector<double> temperature;     ///< [K]
    std::vector<double> pressing;   ///< the concentration that would press as hard at the law's temperature [mol/m^2]
    std::vector<double> tension;    ///< of one interface [N/m]
    std::vector<Vec3> along;        ///< velocity along the film [m/s]
    std::vector<std::uint8_t> dry;  ///< 1: hardly a fine particle reaches it

    std::size_t size() const { return thickness.size(); }
};

/// @param even  per region
Films films_of(const Geometry& geometry,
               const CoarseParticles& coarse,
               const Gathered& gathered,
               const std::vector<EvenFilm>& even,
               const film::SurfactantLaw& law,
               const Heat& heat);

/// The mean over the neighbors of the same film that are not marked, weighted by kernels; nothing where there are none.
template <class Value>
std::optional<Value> mean_around(const Geometry& geometry,
                                 const std::vector<std::uint8_t>& marked,
                                 std::size_t i,
                                 const std::vector<Value>& values) {
    const Neighbors& same = geometry.neighbors.same;
    double weights = 0.0;
    Value sum{};
    for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
        const std::size_t j = same.index[k];
        if (marked[j] != 0) continue;
        const double weight = geometry.area[j] * same.weight[k];
        weights += weight;
        sum += weight * values[j];
    }
    if (!(weights > 0.0)) return std::nullopt;
    return sum / weights;
}

}  // namespace lamella::melp
