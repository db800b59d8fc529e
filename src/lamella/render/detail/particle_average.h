#pragma once

#include "lamella/core/vec.h"
#include "lamella/sim/frame.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace lamella::render::detail {

/// Particles that carry what films show, beside the films.
struct FilmParticles {
    std::vector<Vec3> position;
    std::vector<double> value;
    std::vector<std::int32_t> region;  ///< beside the film of each; empty: not told, there is one film
};

/// Those that carry the films' thickness [m]: points without a radius that have a field of it beside films. Where some
/// of them are marked `fine`, the others are left out: they are coarser, and their films' vertices say what they know.
std::optional<FilmParticles> thickness_particles(const sim::Frame& frame);

/// The value of scattered particles at any place of a film: the mean of those nearby, weighted with (1 - d^2/r^2)^2 for
/// distances d below r, two of their spacings; where there are none, of the nearest within 2 r.
class ParticleAverage {
public:
    /// @param spacing  how far apart the particles lie: the root of their share of the films' area
    ParticleAverage(const FilmParticles& particles, double spacing);

    /// @param regions  on both sides of the film; particles beside other regions do not count
    std::optional<double> at(const Vec3& place, const std::array<std::int32_t, 2>& regions) const;

private:
    std::uint64_t key(const Vec3& place, int dx, int dy, int dz) const;

    struct Entry {
        std::uint64_t key;
        Vec3 place;
        double value;
        std::int32_t region;
    };
    double radius_ = 1.0;
    std::vector<Entry> entries_;  ///< sorted by key
};

/// Of the films' area over the particles, its root.
double particle_spacing(const sim::Surface& films, std::size_t particles);

}  // namespace lamella::render::detail
