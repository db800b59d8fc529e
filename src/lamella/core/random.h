#pragma once

// Random numbers without a generator: a draw is a pure function of (seed, stream, step, item, draw). Nothing is shared
// and nothing advances, so the order of calls, the number of threads and the number of ranks cannot change a result,
// and a resumed run draws what an uninterrupted one would have drawn.
//
//     const RandomBits bits = random_bits(seed, RandomStream::kBubbleRadius, 0, bubble_id);
//     const double radius = lognormal(bits, mean, deviation);
//
// What is guaranteed: the bits, uniform01 and uniform_vector are the same on every machine and compiler. normal,
// lognormal and unit_vector go through log, exp, sin and cos of the C library, which may round the last bit differently
// from one machine to another; on one machine they repeat exactly.

#include "lamella/core/vec.h"

#include <array>
#include <cstdint>

namespace lamella {

/// What a draw is for. Each purpose has its own stream, so a new purpose shifts no other's numbers: add at the end, and
/// never reuse or change a value. Values stay below 2^16.
enum class RandomStream : std::uint32_t {
    kBubblePosition = 1,  ///< centers placed at random
    kBubbleJitter = 2,    ///< displacement from the points of a grid
    kBubbleRadius = 3,    ///< initial size distribution
    kFilmRupture = 4,     ///< which film bursts, and when
    kClusterPosition = 5, ///< bubbles of a cluster before they are packed
    kMeshJitter = 6,      ///< vertices off the planes of a grid
    kAnneal = 7,          ///< volumes while a cluster looks for a better shape
    kFoamSizes = 8,       ///< volumes of a cluster's bubbles
    kFilmNoise = 9,       ///< slopes of the smooth noise on films
    kFilmParticle = 10,   ///< where particles lie in a triangle of film at the start
    kFaucet = 11,         ///< sizes of bubbles that enter on the way
    kPicture = 20,        ///< where the rays of a picture start (12 to 19 are kept for solvers)
};

/// 128 random bits.
struct RandomBits {
    std::array<std::uint32_t, 4> word{};

    /// The first (k = 0) or second (k = 1) 64 bits.
    constexpr std::uint64_t half(std::size_t k) const {
        return (static_cast<std::uint64_t>(word[2 * k + 1]) << 32) | word[2 * k];
    }

    friend bool operator==(const RandomBits&, const RandomBits&) = default;
};

/// Philox4x32-10 [Salmon11] with key `seed` and a counter made of the other arguments.
///
/// @param step  a time step, or 0 where there is none; below 2^40
/// @param item  the element's permanent id, never its place in an array that is sorted or compacted
/// @param draw  0 to 255, for whoever needs more than 128 bits for one item (rejection, three normals)
RandomBits random_bits(
    std::uint64_t seed, RandomStream stream, std::uint64_t step, std::uint64_t item, std::uint32_t draw = 0);

/// Uniform in [0, 1): a multiple of 2^-53. The two halves k = 0, 1 are independent.
constexpr double uniform01(const RandomBits& bits, std::size_t k = 0) {
    return static_cast<double>(bits.half(k) >> 11) * 0x1.0p-53;
}

/// Uniform in [0, 1)^D, independent coordinates: multiples of 2^-53 (D = 2) or 2^-42 (D = 3). Uses all of `bits`.
template <int D>
Vec<D> uniform_vector(const RandomBits& bits);
template <>
Vec2 uniform_vector<2>(const RandomBits& bits);
template <>
Vec3 uniform_vector<3>(const RandomBits& bits);

/// Two independent normal deviates of mean 0 and variance 1 (Box-Muller); |x| < 8.6. Uses all of `bits`.
Vec2 normal_pair(const RandomBits& bits);

/// The first of normal_pair.
double normal(const RandomBits& bits);

/// exp of a normal deviate, scaled so that the variable itself has this mean and standard deviation:
/// with s^2 = log(1 + (deviation / mean)^2), x = mean exp(s n - s^2 / 2). Uses all of `bits`.
///
/// @param mean       more than 0, any unit
/// @param deviation  at least 0, same unit
double lognormal(const RandomBits& bits, double mean, double deviation);

/// A direction, uniform on the circle (D = 2) or sphere (D = 3); length 1 to rounding. Uses all of `bits`.
template <int D>
Vec<D> unit_vector(const RandomBits& bits);
template <>
Vec2 unit_vector<2>(const RandomBits& bits);
template <>
Vec3 unit_vector<3>(const RandomBits& bits);

}  // namespace lamella
