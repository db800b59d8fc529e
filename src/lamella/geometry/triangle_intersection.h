#pragma once

#include "lamella/core/vec.h"

#include <array>

namespace lamella::geometry {

using Triangle = std::array<Vec3, 3>;

// Exact tests of closed sets: touching in a single point counts as meeting. Triangles without area meet whatever lies
// in line with them.

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Triangle& t);

/// Two triangles without a common corner.
bool triangles_meet(const Triangle& s, const Triangle& t);

/// Two triangles whose first `shared` corners (1 or 2) are the same: whether they meet anywhere else.
bool triangles_meet_beyond_shared(const Triangle& s, const Triangle& t, int shared);

}  // namespace lamella::geometry
