#include "lamella/render/detail/assumed_thickness.h"

#include <algorithm>
#include <cmath>

namespace lamella::render::detail {
namespace {

/// A number in [-1, 1] for each point of a lattice.
double lattice_value(std::int64_t x, std::int64_t y, std::int64_t z) {
    auto h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U ^ static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FU ^
             static_cast<std::uint64_t>(z) * 0x165667B19E3779F9U;
    h = (h ^ (h >> 29)) * 0xBF58476D1CE4E5B9U;
    h = (h ^ (h >> 32)) * 0x94D049BB133111EBU;
    return static_cast<double>(h >> 11) * 0x1.0p-52 - 1.0;
}

/// Smooth noise of wavelength about 1: the lattice's values, blended with quintic weights.
double noise(const Vec3& p) {
    std::int64_t cell[3];
    double weight[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const double floor = std::floor(p[k]), t = p[k] - floor;
        cell[k] = static_cast<std::int64_t>(floor);
        weight[k] = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double w = 1.0;
        for (int k = 0; k < 3; ++k) w *= (corner >> k & 1) != 0 ? weight[k] : 1.0 - weight[k];
        sum += w * lattice_value(cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1), cell[2] + (corner >> 2 & 1));
    }
    return sum;
}

}  // namespace

double assumed_thickness(const Vec3& place, std::uint32_t film) {
    constexpr double kThin = 180e-9, kThick = 780e-9;  // [m]
    const double own = lattice_value(film, 17, 4711);
    const Vec3 shift{{13.7 * own, 7.1 * own, 3.3 * own}};
    // Swirls: places are moved along a smooth field before the bands are read off; flat ones, as films flow sideways
    // easily.
    const Vec3 p = 2.2 * place + shift;
    const Vec3 flow{{noise(p), noise(p + Vec3{{31.4, 0.0, 0.0}}), noise(p + Vec3{{0.0, 27.2, 0.0}})}};
    const Vec3 q = place + 0.16 * flow;
    const Vec3 flat{{3.0 * q[0], 3.0 * q[1], 7.5 * q[2]}};
    const double ripples = 0.6 * noise(flat + shift) + 0.3 * noise(2.3 * flat + shift);
    const double height = std::clamp(0.5 + 0.5 * q[2] + 0.10 * ripples + 0.05 * own, 0.0, 1.1);
    const double drained = kThin + (kThick - kThin) * std::pow(1.0 - height / 1.1, 1.25);
    return std::max(20e-9, drained);
}

}  // namespace lamella::render::detail
