#include "lamella/solvers/vortex_particle/solids.h"

#include <algorithm>

namespace lamella::vortex_particle {

Cover cover_of(const Surface& s, std::span<const film::Solid> solids, double time) {
    Cover cover{std::vector<double>(s.triangles(), 0.0), std::vector<Vec3>(s.triangles())};
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const Vec3 x = s.point(t, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
        for (const film::Solid& solid : solids) {
            const Vec3 arm = x - solid.center_at(time);
            const double share = std::clamp((solid.radius - norm(arm)) / s.mean_edge, 0.0, 1.0);
            if (share <= cover.share[t]) continue;
            Vec3 u = solid.moves(time) ? solid.velocity + cross(solid.spin, arm) : Vec3{};
            u -= dot(u, s.normal[t]) * s.normal[t];
            cover.share[t] = share;
            cover.velocity[t] = u;
        }
    }
    return cover;
}

double fastest(std::span<const film::Solid> solids) {
    double speed = 0.0;
    for (const film::Solid& solid : solids)
        speed = std::max(speed, norm(solid.velocity) + norm(solid.spin) * solid.radius);
    return speed;
}

}  // namespace lamella::vortex_particle
