#pragma once

#include "lamella/core/vec.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace lamella::melp {

/// One component of a vector column for the lanes of a block; lanes that are not there repeat the last particle.
template <std::size_t N>
void load_lanes(std::span<const Vec3> column,
                std::size_t first,
                std::size_t count,
                std::array<std::array<double, N>, 3>& to) {
    for (std::size_t l = 0; l < N; ++l) {
        const Vec3& x = column[first + std::min(l, count - 1)];
        for (std::size_t k = 0; k < 3; ++k) to[k][l] = x[k];
    }
}

}  // namespace lamella::melp
