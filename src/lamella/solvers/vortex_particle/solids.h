#pragma once

// Solid balls in a film: where they are the film moves with them.

#include "lamella/film/problem.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <span>
#include <vector>

namespace lamella::vortex_particle {

/// What holds each triangle: a share between 0 and 1 that a solid covers, over a layer of one edge at its surface, and the
/// solid's velocity along the film there.
struct Cover {
    std::vector<double> share;
    std::vector<Vec3> velocity;  ///< [m/s]; where solids overlap, of the one that covers more
};
Cover cover_of(const Surface& s, std::span<const film::Solid> solids, double time);

/// The largest speed of any solid's surface [m/s].
double fastest(std::span<const film::Solid> solids);

}  // namespace lamella::vortex_particle
