// Momentum of the films, and what is given back of it where coarse particles lose it.

#include "lamella/linalg/small_cholesky.h"
#include "lamella/solvers/melp/flight.h"
#include "lamella/solvers/melp/free_clusters.h"
#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/melp/population.h"

#include <array>

namespace lamella::melp {

/// Momentum of each region's film that moves with these velocities, per density [m^4/s].
std::vector<Vec3> MelpSolver::region_momenta(std::span<const Vec3> velocity) const {
    std::vector<Vec3> momentum(gas_.size());
    for (std::size_t i = 0; i < coarse_.size(); ++i)
        momentum[static_cast<std::size_t>(coarse_.region[i])] += films_.liquid_volume[i] * velocity[i];
    return momentum;
}

/// Mean velocity of each region's film, by mass.
std::vector<Vec3> MelpSolver::region_velocities() const {
    std::vector<Vec3> velocity = region_momenta(coarse_.velocity);
    std::vector<double> volume(gas_.size(), 0.0);
    for (std::size_t i = 0; i < coarse_.size(); ++i)
        volume[static_cast<std::size_t>(coarse_.region[i])] += films_.liquid_volume[i];
    for (std::size_t r = 0; r < gas_.size(); ++r) velocity[r] = velocity[r] / volume[r];
    return velocity;
}

/// Clusters of bubbles that touch no rim and have no hole, one number for each; -1: regions of others. Only as a whole
/// they keep their momentum: within them films push each other.
std::vector<std::ptrdiff_t> MelpSolver::flying_clusters() const {
    const std::vector<std::size_t> cluster = clusters(geometry_, gas_.size());
    std::vector<std::ptrdiff_t> flying(cluster.begin(), cluster.end());
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (gas_[r].held || gas_[r].burst) flying[cluster[r]] = -1;
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (flying[cluster[r]] < 0) flying[r] = -1;
    return flying;
}

/// The filter, coarse particles that slip through the film, those added and taken change the
/// momentum of what flies by a few millionths of m c. The uniform velocity along the normals that has it is added.
void MelpSolver::give_back_to_liquid(const std::vector<Vec3>& momentum) {
    if (fine_.size() == 0) return;
    const std::vector<std::ptrdiff_t> cluster = flying_clusters();
    std::vector<Vec3> missing(gas_.size());                 // of each cluster, at its smallest region
    std::vector<std::array<double, 9>> along(gas_.size());  // sum V n n^T
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (cluster[r] >= 0) missing[static_cast<std::size_t>(cluster[r])] += momentum[r];
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        const std::ptrdiff_t c = cluster[static_cast<std::size_t>(coarse_.region[i])];
        if (c < 0) continue;
        const Vec3& n = geometry_.normal[i];
        missing[static_cast<std::size_t>(c)] -= films_.liquid_volume[i] * velocity_of(i);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t m = 0; m < 3; ++m)
                along[static_cast<std::size_t>(c)][3 * k + m] += films_.liquid_volume[i] * n[k] * n[m];
    }
    std::vector<Vec3> added(gas_.size());
    for (std::size_t r = 0; r < gas_.size(); ++r) {
        std::array<double, 3> u{missing[r][0], missing[r][1], missing[r][2]};
        if (cluster[r] == static_cast<std::ptrdiff_t>(r) && linalg::solve_positive<3>(along[r], u))
            added[r] = {{u[0], u[1], u[2]}};
    }
    add_along_normals(cluster, added);
}

/// The same for films without fine particles, which fly as their motion along the normals says.
void MelpSolver::give_back_to_even_films(const std::vector<Vec3>& drift) {
    if (fine_.size() > 0) return;
    const std::vector<std::ptrdiff_t> cluster = flying_clusters();
    const std::vector<Vec3> now = region_drifts_now();
    std::vector<Vec3> missing(gas_.size());
    std::vector<double> volume(gas_.size(), 0.0);
    for (std::size_t r = 0; r < gas_.size(); ++r) {
        if (cluster[r] < 0) continue;
        const auto c = static_cast<std::size_t>(cluster[r]);
        missing[c] += even_[r].liquid_volume * (drift[r] - now[r]);
        volume[c] += even_[r].liquid_volume;
    }
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (volume[r] > 0.0) missing[r] = missing[r] / volume[r];
    add_along_normals(cluster, missing);
}

/// How films fly that have no fine particles.
std::vector<Vec3> MelpSolver::region_drifts_now() const {
    std::vector<double> along_normal(coarse_.size());
    for (std::size_t i = 0; i < coarse_.size(); ++i) along_normal[i] = dot(coarse_.velocity[i], geometry_.normal[i]);
    return Flight(geometry_, coarse_, geometry_.area, gas_.size()).of(along_normal);
}

/// Adds to the clusters' films the part along the normals of a uniform velocity.
void MelpSolver::add_along_normals(const std::vector<std::ptrdiff_t>& cluster, const std::vector<Vec3>& velocity) {
    for_each_particle(coarse_.size(), [&](std::size_t i) {
        const std::ptrdiff_t c = cluster[static_cast<std::size_t>(coarse_.region[i])];
        const Vec3& n = geometry_.normal[i];
        if (c >= 0) coarse_.velocity[i] += dot(velocity[static_cast<std::size_t>(c)], n) * n;
    });
}

/// Films that stretch or shrink get or lose coarse particles. Their liquid is that of the fine ones, or of all; what
/// momentum that costs is given back with the rest.
void MelpSolver::keep_spacing() {
    if (options_.insertion && repopulate(coarse_, geometry_, gas_)) update_shape();
}

}  // namespace lamella::melp
