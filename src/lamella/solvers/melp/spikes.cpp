// Coarse particles that leave their film at folds.

#include "lamella/solvers/melp/flight.h"
#include "lamella/solvers/melp/free_clusters.h"
#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/melp_solver.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {

/// Where films fold at a junction, cohesion is stronger than the particle's own film: without a limit single particles
/// leave their film there and stretch it until it tears. What a particle stands out of the patch of its neighbors
/// beyond a tenth of the spacing is taken back by and by, and so is the velocity with which it left; what that pushes
/// and twists a cluster with that flies goes back to all of it.
void MelpSolver::pull_back_spikes(double dt) {
    constexpr double kFree = 0.1;  // spacings
    constexpr double kShare = 0.3;
    std::vector<double> impulse(coarse_.size(), 0.0);  // along the normals, per density [m^4/s]
    bool any = false;
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        const double height = geometry_.patch[i].c[0], most = kFree * spacing_;
        const double back = kShare * (height - std::clamp(height, -most, most));
        if (back == 0.0) continue;
        const Vec3& n = geometry_.patch[i].frame.normal;
        coarse_.position[i] += back * n;
        gas_[static_cast<std::size_t>(coarse_.region[i])].volume += geometry_.area[i] * back;
        const double away = -std::copysign(1.0, back) * dot(coarse_.velocity[i], geometry_.normal[i]);
        if (away <= 0.0) continue;
        impulse[i] = films_.liquid_volume[i] * std::copysign(std::min(away * dt, std::abs(back)) / dt, back);
        any = true;
    }
    if (!any) return;
    const std::vector<Vec3> nothing(coarse_.size());
    const std::vector<Tensor> maps = fine_.size() == 0
                                         ? Flight(geometry_, coarse_, geometry_.area, gas_.size()).over_sphere()
                                         : std::vector<Tensor>{};
    for (const FreeCluster& cluster : free_clusters(coarse_, geometry_, gas_, rims_now_, maps))
        if (cluster.flies()) cluster.remove_resultant(impulse, nothing, films_.liquid_volume);
    for_each_particle(coarse_.size(), [&](std::size_t i) {
        coarse_.velocity[i] += impulse[i] / films_.liquid_volume[i] * geometry_.normal[i];
    });
}

}  // namespace lamella::melp
