#pragma once

#include "lamella/film/problem.h"
#include "lamella/solvers/melp/options.h"

#include <cstdint>
#include <vector>

namespace lamella::melp {

/// Liquid of a film at the start, per material.thickness, its spots aside.
class StartThickness {
public:
    /// @param largest_radius  of the scene's films, for the default wave length of the noise [m]
    StartThickness(const film::Problem& films, const StartOptions& options, std::uint64_t seed, double largest_radius);

    /// Sets the range of heights of a film. @param thickness  of it [m]; 0: material.thickness
    void begin(const std::vector<Vec3>& position, double thickness);
    /// @param arm  from the film's center [m]
    double at(const Vec3& x, const Vec3& arm) const;
    /// Whether a place is in a spot of black film, which is spot_thickness thick.
    bool in_spot(const Vec3& x) const;

private:
    void place_spots(const std::vector<Vec3>& position);

    StartOptions options_;
    double wave_length_;
    std::uint64_t seed_;
    double thickness_;
    Vec3 up_;
    std::vector<Vec3> spots_;
    double low_ = 0.0, high_ = 0.0, own_ = 1.0;
};

}  // namespace lamella::melp
