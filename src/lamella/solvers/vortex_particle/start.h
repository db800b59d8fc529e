#pragma once

#include "lamella/film/problem.h"
#include "lamella/solvers/vortex_particle/flow.h"
#include "lamella/solvers/vortex_particle/options.h"
#include "lamella/solvers/vortex_particle/particles.h"
#include "lamella/solvers/vortex_particle/transfer.h"

#include <cstdint>
#include <vector>

namespace lamella::vortex_particle {

/// Vorticity at a point with film normal `n` [1/s]; vortices of profile kHole have none.
double vorticity(std::span<const film::Vortex> vortices, const Vec3& x, const Vec3& n);

/// The integral of phi_i times the vorticity [m^2/s], by the midpoints of 16 parts of each triangle. On a component
/// without walls, where it has to sum to zero, what is over is spread evenly over the area.
std::vector<double> vertex_circulation(const Surface& s, std::span<const film::Vortex> vortices);

/// Of each loop of the surface, counterclockwise around the hole.
std::vector<double> hole_circulation(const Surface& s, std::span<const film::Vortex> vortices);

/// Thickness and surfactant as the scene asks for them, without noise, and without the surfactant of kBalanced, which
/// needs the whole film.
class Start {
public:
    Start(const Surface& s, const film::Problem& films, const StartOptions& options);

    double thickness(const Vec3& x) const;                       ///< [m]
    double surfactant(const Vec3& x) const;                      ///< [mol/m^2]
    double rest_surfactant() const { return rest_surfactant_; }  ///< Gamma_0 [mol/m^2]

private:
    StartOptions options_;
    double common_, bottom_, top_;  ///< thickness [m]
    double rest_surfactant_;
    Vec3 up_;
    double low_, range_ = 0.0;  ///< of the height along up_
};

/// Particles with the thickness, surfactant and vorticity of a scene, at rest. What they put on the vertices is what
/// the scene asks for: their areas and circulations are corrected to that end in a few sweeps [method sheet 7].
Particles start_particles(
    const Surface& s, const Transfer& transfer, const film::Problem& films, const Options& options, std::uint64_t seed);

}  // namespace lamella::vortex_particle
