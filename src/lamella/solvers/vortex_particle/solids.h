#pragma once

// Solid balls in a film: where they are the film moves with them, and pushes back.

#include "lamella/film/solid.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::vortex_particle {

using film::Body;

/// How firmly a solid holds each triangle, 0 to 1 over a layer of one edge inside its surface, and which solid: where
/// several overlap the one that holds it more. The layer is steep outside, so that it matters little how many sweeps a
/// step has.
struct Cover {
    std::vector<double> share;
    std::vector<std::int32_t> body;  ///< -1: none
};
/// @param spread  how far viscosity carries vorticity in a step, sqrt(nu dt) [m]: between two holds the film inside the
///                solid starts to move, as if the solid were smaller by that much
Cover cover_of(const Surface& s, std::span<const Body> bodies, double spread);

/// One step's hold of solids on the film. Momentum that they give to it they lose: free ones change their velocity in
/// each sweep such that they have given what they lost,
///
///     mass (v - v_before - dt g) = -sum over sweeps of the integral of share rho eta (v - u)
///
/// with the film's weight in the equation for stability whatever the mass.
class Grip {
public:
    /// @param mass  of the film in each triangle [kg]
    Grip(const Surface& s,
         Cover cover,
         std::vector<double> mass,
         std::span<Body> bodies,
         const Vec3& gravity,
         double dt);

    /// What has to be added to `u` of triangles so that the film moves with the solids, where they cover it.
    /// @returns the largest speed that a whole triangle lacks [m/s]
    double sweep(std::span<const Vec3> u, std::vector<Vec3>& change);
    /// Writes forces and torques.
    void finish();

private:
    void let_follow(std::span<const Vec3> u);

    const Surface& surface_;
    Cover cover_;
    std::vector<double> mass_;
    std::span<Body> bodies_;
    Vec3 gravity_;
    double dt_;
    std::vector<Body> before_;
    std::vector<Vec3> given_, turned_;  ///< momentum and angular momentum to the film [kg m/s], [kg m^2/s]
    std::vector<std::uint32_t> covered_;
};

}  // namespace lamella::vortex_particle
