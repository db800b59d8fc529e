#pragma once

#include "lamella/core/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::render::detail {

/// The value of scattered particles at any place: the mean of those nearby, weighted with (1 - d^2/r^2)^2 for distances
/// d below r, about two of their spacings; where there are none, of the nearest within 2 r, else 0.
class ParticleAverage {
public:
    ParticleAverage(std::span<const Vec3> places, std::span<const double> values);

    double at(const Vec3& place) const;

private:
    std::uint64_t key(const Vec3& place, int dx, int dy, int dz) const;

    struct Entry {
        std::uint64_t key;
        Vec3 place;
        double value;
    };
    double radius_ = 1.0;
    std::vector<Entry> entries_;  ///< sorted by key
};

}  // namespace lamella::render::detail
