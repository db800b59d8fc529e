#pragma once

#include "lamella/core/vec.h"

#include <cstdint>

namespace lamella::film {

/// Smooth random unevenness of films at the start: gradient noise [Perlin85] in space, octave by octave of half the
/// wave length and half the amplitude.
struct Noise {
    double amplitude = 0.0;     ///< of the first octave; the noise itself rarely goes beyond 0.7 of it
    double wave_length = 0.01;  ///< of the first octave [m]
    int octaves = 2;
    std::uint64_t seed = 1;

    /// A pure function of the place. [the unit of amplitude]
    double operator()(const Vec3& x) const;
};

}  // namespace lamella::film
