#pragma once

#include "lamella/core/vec.h"

#include <cstdint>

namespace lamella::film {

/// Smooth noise in space without a direction or a period: random slopes on the points of a grid, blended between them
/// with curves of fifth degree [Perlin02]. Zero at the points of the grid, within [-1, 1], its mean near zero.
///
/// @param x     in units of the grid
/// @param seed  another noise for each
double gradient_noise(const Vec3& x, std::uint64_t seed);

/// A sum of `octaves` of it, each of twice the frequency and half the height of the one before.
double gradient_noise(const Vec3& x, std::uint64_t seed, int octaves);

}  // namespace lamella::film
