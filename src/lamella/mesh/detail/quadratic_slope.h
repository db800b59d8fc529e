#pragma once

#include "lamella/core/vec.h"

#include <optional>
#include <span>

namespace lamella::mesh::detail {

/// Slope at the origin of a quadratic height function fitted to points.
///
///   w(u, v) = c0 + c1 u + c2 v + c3 u^2 + c4 u v + c5 v^2,   least squares, weights 1 / (1 + |p|^2 / scale^2)
///
/// @param points  (u, v, w) [m]
/// @param scale   size of the patch [m]
/// @returns       (c1, c2) [-], or nothing if the points do not determine the polynomial
std::optional<Vec2> quadratic_slope(std::span<const Vec3> points, double scale);

}  // namespace lamella::mesh::detail
