#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "lamella/core/host_device.h"

// Discs and balls (method sheet, section 1). The size variable is q = R^d: gas moves linearly in it, so that any
// linear time integrator conserves the total to round-off.

namespace lamella::bubble {

/// Cube root of a positive, normal number to about one unit in the last place, in operations that every machine
/// rounds alike: a guess from the exponent bits (5 % off), then three Halley steps (each cubes the error).
LAMELLA_HOST_DEVICE inline double cube_root(double a) {
    std::int64_t bits;
    std::memcpy(&bits, &a, sizeof bits);
    bits = static_cast<std::int64_t>(static_cast<double>(bits) * (1.0 / 3.0)) + 0x2A9F7893782DA1CE;
    double y;
    std::memcpy(&y, &bits, sizeof y);
    for (int step = 0; step < 3; ++step) {
        const double cube = y * y * y;
        y = y * (cube + 2.0 * a) / (2.0 * cube + a);
    }
    return y;
}

template <int D>
struct Shape;

template <>
struct Shape<2> {
    static constexpr double kVolume = std::numbers::pi;         ///< V = kVolume q
    static constexpr double kSurface = 2.0 * std::numbers::pi;  ///< A = kSurface R^(d-1)
    LAMELLA_HOST_DEVICE static double radius(double q) { return std::sqrt(q); }
    LAMELLA_HOST_DEVICE static double size(double r) { return r * r; }
    template <class Real>
    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE static Real surface(const Real& r) {
        return r * kSurface;
    }
};

template <>
struct Shape<3> {
    static constexpr double kVolume = 4.0 / 3.0 * std::numbers::pi;
    static constexpr double kSurface = 4.0 * std::numbers::pi;
    LAMELLA_HOST_DEVICE static double radius(double q) { return q > 0.0 ? cube_root(q) : 0.0; }
    LAMELLA_HOST_DEVICE static double size(double r) { return r * r * r; }
    template <class Real>
    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE static Real surface(const Real& r) {
        return r * r * kSurface;
    }
};

}  // namespace lamella::bubble
