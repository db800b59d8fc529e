#pragma once

#include "lamella/core/vec.h"

namespace lamella::geometry {

/// The point of triangle abc nearest to p, as u a + v b + w c with u + v + w = 1.
struct NearestOnTriangle {
    double u, v, w;
};
NearestOnTriangle nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b);
double squared_distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
/// Between segments ab and cd; either may be a point.
double squared_distance_of_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace lamella::geometry
