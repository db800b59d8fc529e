#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace lamella::mesh::detail {

using Triangle = std::array<Vec3, 3>;

inline Triangle triangle(const FoamMesh& mesh, FaceId f) {
    return {mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)};
}

/// Twice the area times the unit normal, (x1 - x0) x (x2 - x0) [m^2].
inline Vec3 doubled_area_vector(const Triangle& x) { return cross(x[1] - x[0], x[2] - x[0]); }

/// The edge opposite to corner k, in the sense of the face.
inline Vec3 opposite_edge(const Triangle& x, std::size_t k) { return x[(k + 2) % 3] - x[(k + 1) % 3]; }

/// Angle at corner k [rad]; exact to rounding for needles too, unlike acos.
inline double angle(const Triangle& x, std::size_t k) {
    const Vec3 to_next = x[(k + 1) % 3] - x[k];
    const Vec3 to_last = x[(k + 2) % 3] - x[k];
    return std::atan2(norm(cross(to_next, to_last)), dot(to_next, to_last));
}

/// A unit vector, or zero if there is no direction.
inline Vec3 direction(const Vec3& a) {
    const double length = norm(a);
    return length > 0.0 ? a / length : Vec3{};
}

}  // namespace lamella::mesh::detail
