#pragma once

#include "lamella/core/vec.h"

#include <array>

namespace lamella::melp {

/// Three rows.
using Tensor = std::array<Vec3, 3>;

inline Vec3 operator*(const Tensor& a, const Vec3& x) { return {{dot(a[0], x), dot(a[1], x), dot(a[2], x)}}; }

}  // namespace lamella::melp
