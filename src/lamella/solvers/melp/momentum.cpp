// Momentum of the films, and what is given back of it where coarse particles lose it.

#include "lamella/linalg/small_cholesky.h"
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

/// The filter, coarse particles that slip through the film, and those added and taken change a region's momentum by a
/// few millionths of m c. The uniform velocity along the normals that has it is added.
void MelpSolver::give_back_to_liquid(const std::vector<Vec3>& momentum) {
    std::vector<Vec3> velocity(coarse_.size());
    for (std::size_t i = 0; i < coarse_.size(); ++i) velocity[i] = velocity_of(i);
    const std::vector<Vec3> now = region_momenta(velocity);
    std::vector<Vec3> missing(gas_.size());
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (even_[r].liquid_volume == 0.0 && flies(r)) missing[r] = momentum[r] - now[r];
    add_uniform(missing, films_.liquid_volume);
}

/// How films fly that have no fine particles: as their motion along the normals says.
std::vector<Vec3> MelpSolver::region_drifts_now() const {
    std::vector<double> along_normal(coarse_.size());
    for (std::size_t i = 0; i < coarse_.size(); ++i) along_normal[i] = dot(coarse_.velocity[i], geometry_.normal[i]);
    return region_drifts(geometry_, coarse_, along_normal, gas_.size());
}

/// The same for these films, whose momentum is that of a flight at their drift.
void MelpSolver::give_back_to_even_films(const std::vector<Vec3>& drift) {
    std::vector<Vec3> missing = region_drifts_now();
    for (std::size_t r = 0; r < gas_.size(); ++r)
        missing[r] = even_[r].liquid_volume > 0.0 && flies(r) ? drift[r] - missing[r] : Vec3{};
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        const Vec3& n = geometry_.normal[i];
        coarse_.velocity[i] += dot(missing[static_cast<std::size_t>(coarse_.region[i])], n) * n;
    }
}

/// No rim holds its momentum, and no hole lets it go.
bool MelpSolver::flies(std::size_t region) const { return !gas_[region].held && !gas_[region].burst; }

/// Adds to each region the part along the normals of the uniform velocity U for which sum w n n^T U is what is missing.
void MelpSolver::add_uniform(const std::vector<Vec3>& missing, std::span<const double> weight) {
    std::vector<std::array<double, 9>> along(gas_.size());  // sum w n n^T
    for (std::size_t i = 0; i < coarse_.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t m = 0; m < 3; ++m)
                along[static_cast<std::size_t>(coarse_.region[i])][3 * k + m] +=
                    weight[i] * geometry_.normal[i][k] * geometry_.normal[i][m];
    std::vector<Vec3> added(gas_.size());
    for (std::size_t r = 0; r < gas_.size(); ++r) {
        std::array<double, 3> u{missing[r][0], missing[r][1], missing[r][2]};
        if (squared_norm(missing[r]) > 0.0 && linalg::solve_positive<3>(along[r], u)) added[r] = {{u[0], u[1], u[2]}};
    }
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        const Vec3& n = geometry_.normal[i];
        coarse_.velocity[i] += dot(added[static_cast<std::size_t>(coarse_.region[i])], n) * n;
    }
}

/// Films that stretch or shrink get or lose coarse particles. Their liquid is that of the fine ones, or of all; what
/// momentum that costs is given back with the rest.
void MelpSolver::keep_spacing() {
    if (options_.insertion && repopulate(coarse_, geometry_, gas_)) update_shape();
}

}  // namespace lamella::melp
