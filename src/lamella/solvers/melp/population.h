#pragma once

#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/particles.h"

#include <span>

namespace lamella::melp {

/// Adds coarse particles to films that have stretched and takes some from those that have shrunk, so that their spacing
/// stays what it was [method sheet 7 R: thresholds of the area per particle]:
///
///   - where the mean area of a region's particles is a fifth more than at the start, in the middle of the widest gaps
///     next to those with the largest areas; so next to any with 2.5 times the mean area;
///   - where it is a fifth less, those with the smallest areas go; so do any with less than 0.3 of the mean.
///
/// At most a tenth of a region's in one call, none within two spacings of another, none where bubbles touch, none in
/// films that have burst. New ones lie on the patches and move as the film there does.
/// @param geometry  of `coarse`  @returns whether anything has changed: the geometry is out of date then
bool repopulate(CoarseParticles& coarse, const Geometry& geometry, std::span<const Gas> gas);

}  // namespace lamella::melp
