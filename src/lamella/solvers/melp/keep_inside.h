#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/rims.h"

#include <cstdint>
#include <span>

namespace lamella::melp {

/// Particles of films near their rims.
struct RimNeighbors {
    std::span<const RimPiece> rims;
    std::span<const Vec3> film;  ///< coarse particles: they tell on which side of a wire the film is
    std::span<const std::int32_t> film_region;
    double spacing;  ///< of these [m]
    double margin;   ///< how near to a rim particles may come [m]
};

/// Particles that have come nearer to a rim than the margin, or beyond it by less than a spacing, are put back; of
/// their velocity the part toward the rim is taken. Those in a ball or stick leave it along the film: a film that it
/// passes through opens around it, and closes behind it.
/// @param normal  of the film at each particle
void keep_inside(const RimNeighbors& near,
                 std::span<const std::int32_t> region,
                 std::span<const Vec3> normal,
                 std::span<Vec3> position,
                 std::span<Vec3> velocity);

}  // namespace lamella::melp
