#pragma once

#include "lamella/core/vec.h"

#include <span>

namespace lamella::measure::detail {

struct WeightedPoint {
    Vec3 at;
    double weight = 1.0;
};

/// Radius of the sphere that fits points best: minimizes sum w (|x - c|^2 - R^2)^2, a linear problem [Kasa76].
/// Infinite for points in a plane, and for fewer than four.
double fit_sphere_radius(std::span<const WeightedPoint> points);

}  // namespace lamella::measure::detail
