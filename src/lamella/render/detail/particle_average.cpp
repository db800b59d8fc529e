#include "lamella/render/detail/particle_average.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::render::detail {

ParticleAverage::ParticleAverage(std::span<const Vec3> places, std::span<const double> values) {
    // Particles cover films whose extent is that of the unit ball: n of them lie about sqrt(4 pi / n) apart.
    constexpr double kSpacings = 2.0;
    radius_ = kSpacings * std::sqrt(12.566 / static_cast<double>(std::max<std::size_t>(1, places.size())));
    for (std::size_t i = 0; i < std::min(places.size(), values.size()); ++i)
        entries_.push_back({key(places[i], 0, 0, 0), places[i], values[i]});
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
}

std::uint64_t ParticleAverage::key(const Vec3& place, int dx, int dy, int dz) const {
    const auto cell = [&](double x, int shift) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / radius_)) + shift + (1 << 20)) &
               0x1fffff;
    };
    return cell(place[0], dx) << 42 | cell(place[1], dy) << 21 | cell(place[2], dz);
}

double ParticleAverage::at(const Vec3& place) const {
    double sum = 0.0, weights = 0.0, nearest = std::numeric_limits<double>::infinity(), nearest_value = 0.0;
    for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dz = -1; dz <= 1; ++dz) {
                const std::uint64_t k = key(place, dx, dy, dz);
                auto it = std::lower_bound(entries_.begin(), entries_.end(), k,
                                           [](const Entry& e, std::uint64_t want) { return e.key < want; });
                for (; it != entries_.end() && it->key == k; ++it) {
                    const double square = squared_norm(it->place - place);
                    if (square < nearest) nearest = square, nearest_value = it->value;
                    const double t = 1.0 - square / (radius_ * radius_);
                    if (t <= 0.0) continue;
                    sum += t * t * it->value;
                    weights += t * t;
                }
            }
    return weights > 0.0 ? sum / weights : nearest_value;
}

}  // namespace lamella::render::detail
