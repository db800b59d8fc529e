#pragma once

#include "lamella/solvers/melp/films.h"

#include <span>
#include <vector>

namespace lamella::melp {

/// What coarse particles gain, or lose, as films of two regions that lie on each other even out.
struct Exchange {
    std::vector<double> liquid_volume;  ///< [m^3]
    std::vector<double> surfactant;     ///< [mol]
    std::vector<Vec3> momentum;         ///< per density of the liquid [m^4/s]
    std::vector<double> heat;           ///< liquid volume * temperature [m^3 K]
};

/// Liquid, its surfactant, momentum and heat pass between the films of two regions that face each other:
///
///   i gains  k_ij a_i a_j W_ij (eta_j - eta_i),   k_ij = (1 - exp(-rate dt)) / (2 max(1, gamma_i, gamma_j)),
///
/// and j loses as much; Gamma, eta u and eta T in the place of eta for the others. gamma = sum a W is 1 where two even
/// films coincide: their difference falls as exp(-rate t), whatever the steps. Where more film lies nobody gives away
/// more than half of what he has. Regions that have not joined exchange as much as `joined` says. A rate in the place
/// of the published chance per step. [method sheet 10 R]
///
/// @param velocity  of the films, along them and along the normals [m/s]
/// @param joined    per entry of neighbors.other, see Contacts; empty: all have
Exchange exchange_between(const Geometry& geometry,
                          const Films& films,
                          std::span<const Vec3> velocity,
                          std::span<const double> joined,
                          double rate,
                          double dt);

}  // namespace lamella::melp
