#include "lamella/film/noise.h"

#include "lamella/core/random.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lamella::film {
namespace {

/// The slope at a point of the grid: one of the twelve directions to the middles of a cube's edges, sqrt(2) long.
Vec3 slope(std::int64_t i, std::int64_t j, std::int64_t k, std::uint64_t seed) {
    // Two numbers of 32 bits go into the item, the third into the step; what does not fit repeats far away.
    const auto low = [](std::int64_t n) { return static_cast<std::uint64_t>(n) & 0xffffffffULL; };
    const RandomBits bits = random_bits(seed, RandomStream::kFilmNoise, low(k), low(i) << 32 | low(j));
    const std::uint32_t choice = bits.word[0] % 12;
    const double a = (choice & 1U) != 0 ? 1.0 : -1.0, b = (choice & 2U) != 0 ? 1.0 : -1.0;
    switch (choice / 4) {
        case 0: return {{a, b, 0.0}};
        case 1: return {{a, 0.0, b}};
        default: return {{0.0, a, b}};
    }
}

double faded(double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }

}  // namespace

double gradient_noise(const Vec3& x, std::uint64_t seed) {
    std::array<std::int64_t, 3> cell{};
    Vec3 in;
    for (std::size_t a = 0; a < 3; ++a) {
        const double floor = std::floor(x[a]);
        cell[a] = static_cast<std::int64_t>(floor);
        in[a] = x[a] - floor;
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const std::array<int, 3> c{corner & 1, corner >> 1 & 1, corner >> 2};
        double weight = 1.0;
        Vec3 from = in;
        for (std::size_t a = 0; a < 3; ++a) {
            weight *= c[a] != 0 ? faded(in[a]) : 1.0 - faded(in[a]);
            from[a] -= c[a];
        }
        sum += weight * dot(slope(cell[0] + c[0], cell[1] + c[1], cell[2] + c[2], seed), from);
    }
    return std::clamp(sum, -1.0, 1.0);
}

double gradient_noise(const Vec3& x, std::uint64_t seed, int octaves) {
    double sum = 0.0, height = 1.0, frequency = 1.0;
    for (int octave = 0; octave < octaves; ++octave, height *= 0.5, frequency *= 2.0)
        sum += height * gradient_noise(frequency * x, seed + static_cast<std::uint64_t>(octave));
    return sum;
}

}  // namespace lamella::film
