#pragma once

// Film that streams through its frame: it comes in at one end, even and without vorticity, and leaves at the other.

#include "lamella/film/problem.h"
#include "lamella/solvers/vortex_particle/options.h"
#include "lamella/solvers/vortex_particle/particles.h"
#include "lamella/solvers/vortex_particle/start.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <cstdint>
#include <vector>

namespace lamella::vortex_particle {

/// The two ends of a film that is open [method sheet 6.4]; nothing in one that is closed.
class Stream {
public:
    /// @param s  made with the same stream, and alive for as long as this
    /// @throws InputError  options that do not go together with a stream
    Stream(const Surface& s, const film::Problem& films, const Options& options, std::uint64_t seed);

    const Vec3& velocity() const { return velocity_; }
    /// `u` of triangles relative to the stream.
    std::vector<Vec3> relative(std::vector<Vec3> u) const;

    /// Adds the film that came in during the last `dt`, as it was at the start: the strip behind each edge of the
    /// inflow.
    /// @returns its liquid [m^3]
    double let_in(double dt, std::int64_t step, Particles& particles) const;
    /// In front of the outflow particles lose their circulation and their speed beside the stream, so that what leaves
    /// disturbs nothing: to a twentieth over the length of the sponge.
    void absorb(double dt, Particles& particles) const;

private:
    void fill_strip(std::uint32_t t, std::size_t k, double dt, std::int64_t step, Particles& particles) const;

    const Surface& surface_;
    Vec3 velocity_;
    Start fresh_;
    double particle_area_ = 0.0;  ///< [m^2]
    std::uint64_t seed_;
    double sponge_start_ = 0.0, sponge_length_ = 0.0;  ///< along the stream [m]
};

}  // namespace lamella::vortex_particle
