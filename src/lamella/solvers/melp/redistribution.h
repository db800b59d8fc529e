#pragma once

#include "lamella/solvers/melp/geometry.h"

#include <span>
#include <vector>

namespace lamella::melp {

/// Where to shift coarse particles along the film so that they spread more evenly, one pass [m]: [method sheet 16.3]
///
/// long waves:  (1 - s lap) phi = density / mean density - 1 in each region, shift - s grad phi, s = 200 spacing^2;
/// short waves: - 0.3 spacing^2 sum_j a_j grad W_ij, which is what removes disorder.
///
/// Either is at most a tenth of the spacing, but long waves three tenths in films that touch others: where bubbles
/// change their neighbors the edge of one goes back by half a spacing in a step, and with a tenth particles piled up in
/// it to four times their density. A pass in every step keeps densities even while a bubble swings; one that followed
/// more slowly would let densities lag behind the swing, and made it grow by 1.6 % per period.
std::vector<Vec3> evening_shift(const Geometry& geometry,
                                const CoarseParticles& coarse,
                                std::size_t regions,
                                double spacing);

/// (largest - smallest) / mean density, the worst region's.
double density_spread(const Geometry& geometry, const CoarseParticles& coarse, std::size_t regions);

/// Where a shift along the film ends on the particle's patch [m].
Vec3 along_patch(const Patch& patch, const Vec3& shift);

}  // namespace lamella::melp
