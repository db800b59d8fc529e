#include "lamella/solvers/vortex_particle/stream.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/core/random.h"
#include "lamella/solvers/vortex_particle/trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::vortex_particle {

Stream::Stream(const Surface& s, const film::Problem& films, const Options& options, std::uint64_t seed)
    : surface_(s),
      velocity_(options.stream.velocity),
      fresh_(s, films, options.start),
      particle_area_(s.total_area / static_cast<double>(s.triangles()) / options.particles_per_triangle),
      seed_(seed) {
    if (!s.open()) return;
    if (!options.incompressible)
        throw InputError(
            "vortex_particle: streams of elastic films are not built yet; set vortex_particle.incompressible = true");
    if (options.walls == Walls::kNoSlip)
        throw InputError(
            "vortex_particle.walls = \"no_slip\" is not built for a film that streams; its sides let it slip");
    if (options.start.surfactant == SurfactantProfile::kBalanced)
        throw InputError("vortex_particle.start.surfactant = \"balanced\" is not built for a film that streams");
    const Vec3& g = films.material.gravity;
    if (norm(g - dot(g, s.normal[0]) * s.normal[0]) > 1e-9 * norm(g))
        throw InputError("vortex_particle: gravity along a film that streams is not built yet");
    const Vec3 ahead = velocity_ / norm(velocity_);
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const Vec3& x : s.position) {
        first = std::min(first, dot(x, ahead));
        last = std::max(last, dot(x, ahead));
    }
    sponge_length_ = options.stream.sponge * (last - first);
    sponge_start_ = last - sponge_length_;
}

std::vector<Vec3> Stream::relative(std::vector<Vec3> u) const {
    if (surface_.open())
        for (Vec3& at : u) at -= velocity_;
    return u;
}

double Stream::let_in(double dt, std::int64_t step, Particles& particles) const {
    const std::size_t before = particles.size();
    for (std::uint32_t t = 0; t < surface_.triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            if (surface_.opening_of(t, k) == Opening::kInflow) fill_strip(t, k, dt, step, particles);
    double liquid = 0.0;
    for (std::size_t p = before; p < particles.size(); ++p) liquid += particles.volume[p];
    return liquid;
}

void Stream::fill_strip(std::uint32_t t, std::size_t k, double dt, std::int64_t step, Particles& particles) const {
    const double area = dt * norm(cross(velocity_, surface_.edge(t, k)));
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(area / particle_area_)));
    const RandomBits bits =
        random_bits(seed_, RandomStream::kFilmParticle, static_cast<std::uint64_t>(step) + 1, 3 * t + k);
    EvenPoints points(uniform01(bits, 0), uniform01(bits, 1));
    for (std::size_t i = 0; i < count; ++i) {
        const auto [along, age] = points.next();
        Spot spot{t, {}};
        spot.place[(k + 1) % 3] = 1.0 - along;
        spot.place[(k + 2) % 3] = along;
        if (!walk(surface_, spot, age * dt * velocity_)) continue;  // through the film in one step
        const Vec3 x = surface_.point(spot.triangle, spot.place);
        particles.triangle.push_back(spot.triangle);
        particles.place.push_back(spot.place);
        particles.circulation.push_back(0.0);
        particles.area.push_back(area / static_cast<double>(count));
        particles.volume.push_back(particles.area.back() * fresh_.thickness(x));
        particles.amount.push_back(particles.area.back() * fresh_.surfactant(x));
        particles.velocity.push_back(velocity_);
    }
}

void Stream::absorb(double dt, Particles& particles) const {
    if (sponge_length_ == 0.0) return;
    const Vec3 ahead = velocity_ / norm(velocity_);
    const double fastest =
        6.0 * norm(velocity_) / sponge_length_;  // grows linearly along the sponge: exp(-3) at its end
    parallel_for(particles.size(), [&](std::size_t p) {
        const Vec3 x = surface_.point(particles.triangle[p], particles.place[p]);
        const double depth = (dot(x, ahead) - sponge_start_) / sponge_length_;
        if (depth <= 0.0) return;
        const double left = std::exp(-dt * fastest * depth);
        particles.circulation[p] *= left;
        particles.velocity[p] = velocity_ + left * (particles.velocity[p] - velocity_);
    });
}

}  // namespace lamella::vortex_particle
