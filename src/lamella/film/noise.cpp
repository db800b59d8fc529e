#include "lamella/film/noise.h"

#include "lamella/core/random.h"

#include <cmath>

namespace lamella::film {
namespace {

/// The random direction that belongs to a corner of the grid.
Vec3 direction_at(std::uint64_t seed, std::uint64_t octave, const std::int64_t (&cell)[3]) {
    constexpr std::int64_t kWrap = 1 << 20;  // the noise repeats after so many wave lengths
    std::uint64_t item = 0;
    for (const std::int64_t c : cell) item = item * kWrap + static_cast<std::uint64_t>(((c % kWrap) + kWrap) % kWrap);
    return unit_vector<3>(random_bits(seed, RandomStream::kFilmNoise, octave, item));
}

/// Perlin's noise on the unit grid.
double gradient_noise(std::uint64_t seed, std::uint64_t octave, const Vec3& x) {
    std::int64_t low[3];
    Vec3 rest;
    for (std::size_t k = 0; k < 3; ++k) {
        const double floor = std::floor(x[k]);
        low[k] = static_cast<std::int64_t>(floor);
        rest[k] = x[k] - floor;
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        Vec3 from;
        std::int64_t cell[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const int up = (corner >> k) & 1;
            cell[k] = low[k] + up;
            from[k] = rest[k] - up;
            const double t = std::abs(from[k]);
            weight *= 1.0 - t * t * t * (t * (6.0 * t - 15.0) + 10.0);
        }
        sum += weight * dot(direction_at(seed, octave, cell), from);
    }
    return sum;
}

}  // namespace

double Noise::operator()(const Vec3& x) const {
    double sum = 0.0, size = amplitude, length = wave_length;
    for (int octave = 0; octave < octaves; ++octave, size *= 0.5, length *= 0.5)
        sum += size * gradient_noise(seed, static_cast<std::uint64_t>(octave), x / length);
    return sum;
}

}  // namespace lamella::film
