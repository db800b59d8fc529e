#include "lamella/solvers/melp/heat.h"

#include "lamella/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {

double Heat::air(const Vec3& x) const {
    const Vec3 arm = x - options_.center;
    double near = 0.0;  // 1 in the source
    if (options_.source == HeatSource::kBelow) near = -dot(arm, up_) / options_.reach;
    if (options_.source == HeatSource::kBall) near = 1.0 - norm(arm) / options_.reach;
    return rest_ + std::clamp(near, 0.0, 1.0) * (options_.temperature - rest_);
}

void Heat::warm(double dt, FineParticles& fine) const {
    if (!on()) return;
    const double share = -std::expm1(-dt / options_.time);
    parallel_for(fine.size(),
                 [&](std::size_t p) { fine.temperature[p] += share * (air(fine.position[p]) - fine.temperature[p]); });
}

}  // namespace lamella::melp
