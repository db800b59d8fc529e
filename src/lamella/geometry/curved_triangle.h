#pragma once

#include "lamella/core/vec.h"

#include <array>
#include <cstddef>
#include <span>

namespace lamella::geometry {

/// A quadratic triangle: its corners 0, 1, 2, then the points that it passes through between 0-1, 1-2 and 2-0.
using CurvedTriangle = std::array<Vec3, 6>;

/// The point of a quadratic triangle with the given barycentric coordinates (they sum to 1):
///   x = sum_k b_k (2 b_k - 1) x_k + 4 b_k b_(k+1) x_(3+k)
Vec3 point_on(const CurvedTriangle& x, const std::array<double, 3>& barycentric);

/// Direction in which a quadratic triangle leaves the middle of the edge opposite to a corner: tangent to the triangle,
/// perpendicular to the edge, of any length.
///
/// With tail t, head h, middle m of the edge, opposite corner o, and the middles th = t-o, hh = h-o:
///   dS = 2 (x_hh + x_th - x_m) - x_o - (x_t + x_h) / 2     toward the opposite corner of the reference triangle
/// less its part along x_h - x_t, the tangent of the edge's parabola at its middle.
Vec3 edge_conormal(const CurvedTriangle& x, std::size_t opposite);

/// Tangent at the first of the points of a curve: of the polynomial over the length of their chords that fits all of them
/// best, through them if the degree allows. At least two points, no two in a row at the same place.
Vec3 end_tangent(std::span<const Vec3> points, std::size_t degree);

}  // namespace lamella::geometry
