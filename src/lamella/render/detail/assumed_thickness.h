#pragma once

#include "lamella/core/vec.h"

#include <cstdint>

namespace lamella::render::detail {

/// A thickness [m] for films of which nothing is known, for pictures only: what a film looks like that has drained for
/// a while under gravity and been stirred a little. About 200 nm at the top and 900 nm at the bottom, in bands that
/// swirls of a few sizes bend; each film is a bit different.
///
/// @param place   relative to the center of what is seen, in units of its radius; z points up
/// @param film    tells films apart
double assumed_thickness(const Vec3& place, std::uint32_t film);

}  // namespace lamella::render::detail
