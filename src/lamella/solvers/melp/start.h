#pragma once

#include "lamella/film/problem.h"
#include "lamella/solvers/melp/films.h"
#include "lamella/solvers/melp/options.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/rims.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// Particles of the films of a scene, before anything has moved.
struct Start {
    CoarseParticles coarse;
    FineParticles fine;
    std::vector<Gas> gas;        ///< per region of particles
    std::vector<EvenFilm> even;  ///< per region of particles
    Rims rims;                   ///< what holds films that are not closed
    double spacing = 0.0;        ///< of the coarse particles: sqrt(area / number) [m]
};

/// Every closed region of the problem gets particles on all of its surface, normals outward; a film between two of them
/// so has two layers. Spheres get Fibonacci's spiral, which is even to 0.1 % [method sheet 16.1], other shapes the
/// vertices of their mesh. Films on wires get particles as OpenFilm says. Gas has the pressure that the virial theorem
/// gives: p - p_out = 2/3 film tension * area / volume, 4 sigma / R for a sphere.
/// @throws InputError  films that this solver does not know, or no bubble
Start start_particles(const film::Problem& films, const Options& options, std::uint64_t seed);

/// What holds the films on wires of a scene: their regions of particles come after those of its bubbles.
Rims start_rims(const film::Problem& films, const Options& options);

/// @throws InputError  films that this solver does not know, or several bubbles that it could not follow through a
/// contact
void refuse_unknown_films(const film::Problem& films, const Options& options);

/// `count` points spread evenly over the unit sphere along a spiral: point i has height 1 - (2 i + 1) / count and turns
/// by the golden angle from the one before.
std::vector<Vec3> fibonacci_sphere(std::size_t count);

/// The volume that closes in under the particles of each region, sum a (x - o) . n / 3 about their center o, or a point
/// of the plate that they stand on, times the calibration of its gas [m^3]. Where other bubbles are near, stars of
/// triangles take the place of a (x - o) . n / 3: they are right at folds but flicker with the choice of triangles; and
/// half of what bubbles share is taken off. Without meaning for films without gas.
std::vector<double> particle_volumes(const CoarseParticles& coarse,
                                     const Geometry& geometry,
                                     std::span<const RimPiece> rims,
                                     const std::vector<Gas>& gas);

}  // namespace lamella::melp
