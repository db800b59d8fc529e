#include "lamella/solvers/melp/start_thickness.h"

#include "lamella/core/random.h"
#include "lamella/film/noise.h"

#include <algorithm>
#include <limits>

namespace lamella::melp {

StartThickness::StartThickness(const film::Problem& films,
                               const StartOptions& options,
                               std::uint64_t seed,
                               double largest_radius)
    : options_(options),
      wave_length_(options.noise_length > 0.0 ? options.noise_length : 1.4 * largest_radius),
      seed_(seed),
      thickness_(films.material.thickness),
      up_(norm(films.material.gravity) > 0.0 ? -films.material.gravity : Vec3{{0.0, 0.0, 1.0}}) {
    up_ = up_ / norm(up_);
}

void StartThickness::begin(const std::vector<Vec3>& position, double thickness) {
    own_ = thickness > 0.0 ? thickness / thickness_ : 1.0;
    place_spots(position);
    low_ = std::numeric_limits<double>::infinity();
    high_ = -low_;
    for (const Vec3& x : position) {
        low_ = std::min(low_, dot(up_, x));
        high_ = std::max(high_, dot(up_, x));
    }
}

bool StartThickness::in_spot(const Vec3& x) const {
    return std::any_of(spots_.begin(), spots_.end(), [&](const Vec3& spot) {
        return squared_norm(x - spot) < options_.spot_radius * options_.spot_radius;
    });
}

/// At the fine particle that is nearest to spot_center, or at some drawn from those in reach.
void StartThickness::place_spots(const std::vector<Vec3>& position) {
    spots_.clear();
    if (options_.spots == 0 || position.empty()) return;
    std::vector<Vec3> near;
    const Vec3* nearest = &position[0];
    for (const Vec3& x : position) {
        const double square = squared_norm(x - options_.spot_center);
        if (square < squared_norm(*nearest - options_.spot_center)) nearest = &x;
        if (square <= options_.spot_spread * options_.spot_spread) near.push_back(x);
    }
    if (options_.spot_spread == 0.0) spots_ = {*nearest};
    if (near.empty()) return;
    for (int k = 0; k < options_.spots && options_.spot_spread > 0.0; ++k) {
        const double u = uniform01(random_bits(seed_, RandomStream::kFilmParticle, 1, static_cast<std::uint64_t>(k)));
        spots_.push_back(
            near[std::min(near.size() - 1, static_cast<std::size_t>(u * static_cast<double>(near.size())))]);
    }
}

double StartThickness::at(const Vec3& x, const Vec3& arm) const {
    const double top = options_.thickness_top > 0.0 ? options_.thickness_top / thickness_ : own_;
    const double bottom = options_.thickness_bottom > 0.0 ? options_.thickness_bottom / thickness_ : own_;
    const double height = high_ > low_ ? (dot(up_, x) - low_) / (high_ - low_) : 0.5;
    const double noise =
        options_.thickness_noise * film::gradient_noise(arm / wave_length_, seed_, options_.noise_octaves);
    constexpr double kThinnest = 0.05;
    return std::max((bottom + height * (top - bottom)) * (1.0 + noise), kThinnest);
}

}  // namespace lamella::melp
