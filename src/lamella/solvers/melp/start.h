#pragma once

#include "lamella/film/problem.h"
#include "lamella/solvers/melp/films.h"
#include "lamella/solvers/melp/options.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/rims.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// Particles of the films of a scene, before anything has moved.
struct Start {
    CoarseParticles coarse;
    FineParticles fine;
    std::vector<Gas> gas;              ///< per region of particles
    std::vector<EvenFilm> even;        ///< per region of particles
    Rims rims;                         ///< what holds films that are not closed
    double spacing = 0.0;              ///< of the coarse particles: sqrt(area / number) [m]
    std::vector<RegionPair> joined{};  ///< regions that share films from the start
};

/// Every closed region of the problem gets particles on all of its surface, normals outward; a film between two of them
/// so has two layers. Clusters whose cells have not the volumes they should, as those of [foam] and of bubbles that
/// overlap, start as balls that are moved apart until a hundredth of a radius is between them. Spheres get Fibonacci's
/// spiral, which is even to 0.1 % [method sheet 16.1], other shapes the vertices of their mesh. Films on wires get
/// particles as OpenFilm says. Gas has the pressure that the virial theorem gives: p - p_out = 2/3 film tension * area
/// / volume, 4 sigma / R for a sphere.
/// @throws InputError  films that this solver does not know, or no bubble
Start start_particles(const film::Problem& films, const Options& options, std::uint64_t seed);

/// Adds a bubble that enters on the way, behind all particles that are there.
void append_release(
    Start& start, const film::Problem& films, const Options& options, const film::Release& release, std::uint64_t seed);

/// What holds the films on wires of a scene: their regions of particles come after those of its bubbles.
Rims start_rims(const film::Problem& films, const Options& options);

/// `count` points spread evenly over the unit sphere along a spiral: point i has height 1 - (2 i + 1) / count and turns
/// by the golden angle from the one before.
std::vector<Vec3> fibonacci_sphere(std::size_t count);

}  // namespace lamella::melp
