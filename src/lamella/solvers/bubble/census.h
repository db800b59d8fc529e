#pragma once

#include <cstdint>
#include <vector>

#include "lamella/solvers/bubble/system.h"

namespace lamella::bubble {

/// What the contacts say about each bubble and about the foam, for output and for the test of rest. Columns follow
/// the foam's slots; vanished bubbles hold zeros.
template <int D>
struct Census {
    std::vector<std::int32_t> contacts;
    Column energy;         ///< sum of U_ij over the bubble's contacts: each contact counts for both bubbles
    Column energy_thesis;  ///< likewise sigma_0 (S - d)^2 / 2                       [Lankinen20, eq. 3.2]
    Column pressure;       ///< sum of |F_ij| d_ij / (2 D V_i)
    Column force;          ///< sum of |F_ij|
    Column free_surface;   ///< A_i^f/A_i, the share of the surface that no film covers

    double total_energy = 0.0;         ///< sum of U_ij over contacts
    double total_energy_thesis = 0.0;  ///< sigma_0 sum of (S - d)^2 over contacts: eq. 3.2, which counts each twice
    double mean_contact_force = 0.0;
    std::int64_t total_contacts = 0;
    double mean_free_surface = 0.0;    ///< sum A^f / sum A
    double critical_radius = 0.0;      ///< rho of eq. 2.28; 0 when no surface is free
    /// sigma_ab = -(1/V_box) sum_contacts F_a r_b, row by row
    std::array<double, static_cast<std::size_t>(D * D)> stress{};
};

/// Collective; the sums are those of the whole foam. Brings the copies in system.foam up to date.
template <int D>
Census<D> take_census(System<D>& system, const Options& options);

}  // namespace lamella::bubble
