#pragma once

// Straight on, over the edges of a surface of triangles.

#include "lamella/solvers/vortex_particle/particles.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <array>
#include <cstdint>
#include <span>

namespace lamella::vortex_particle {

/// A point of the surface.
struct Spot {
    std::uint32_t triangle;
    std::array<double, 3> place;  ///< barycentric coordinates
};

/// Moves a spot along `displacement`, a vector of its triangle's plane that is turned about each edge that it crosses;
/// a wall, or a line where films meet, takes away what points out of the film. [method sheet 5.9]
/// @returns  whether it is still in the film: false where it came to an outflow, and stays there
bool walk(const Surface& s, Spot& spot, Vec3 displacement);

/// Which way particles take where films meet: drawn at random from these and their place in the list, which is the same
/// on any number of threads and after a resume.
struct Draw {
    std::uint64_t seed = 0;
    std::uint64_t step = 0;
};

/// Moves particles for a time `dt` with the velocity that is linear between vertices (the fourth-order method of Runge
/// and Kutta), and turns what velocity they carry along with the surface. Those that leave the film through an outflow
/// get the triangle kGone. Over a triple line each goes on into one of the other films, with a probability as the flow
/// into it is; its circulation is then seen from the side of that film which lies in the same wedge.
/// @param velocity  of vertices [m/s]
void trace(const Surface& s, std::span<const Vec3> velocity, double dt, Particles& particles, const Draw& draw = {});

}  // namespace lamella::vortex_particle
