#pragma once

#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/particles.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// How far into free edges coarse particles are: |sum_j a_j grad W_ij| times the support radius, 0 inside and beyond
/// rims that hold; about 1.7 on the edge itself.
std::vector<double> edge_strength(const Geometry& geometry, const CoarseParticles& coarse);

/// Particles that feel a free edge: those with an edge strength above 0.25, and their neighbors. [method sheet 9 R]
/// @param burst  per region: only films that have burst have free edges
std::vector<std::uint8_t> edge_zone(const Geometry& geometry,
                                    const CoarseParticles& coarse,
                                    std::span<const double> strength,
                                    std::span<const std::uint8_t> burst);

/// What tension pulls particles of the zone with along the film [N]: the part along it of the sum over pairs
///
///   2 sigma a_i a_j omega_ij (x_j - x_i) = 4 sigma a_i a_j grad W_ij,
///
/// which is nothing inside. Pairs pull each other, so that over the whole zone just the tension of the film behind it
/// is left, 2 sigma per length, however its particles lie: rims of holes reach the speed of Taylor and Culick,
/// sqrt(2 sigma / (rho eta)). [method sheet 9 R]
std::vector<Vec3> edge_pull(const Geometry& geometry,
                            const CoarseParticles& coarse,
                            std::span<const double> interface_tension,
                            std::span<const std::uint8_t> zone);

/// Change of velocity per time [m/s^2] by forces that each particle's neighborhood takes up as a whole: force j goes to
/// particles i by their share m_i W_ij of the mass around j. None is left over, and particles on an edge that hardly
/// have any liquid are not thrown.
std::vector<Vec3> shared_acceleration(const Geometry& geometry,
                                      std::span<const Vec3> force,
                                      std::span<const double> mass);

/// Coarse particles to be removed [1: yes]: of films that have burst, those within half a spacing of one that stays;
/// those that are deeper in an edge stay rather than others. Their liquid is that of the fine particles, which stay.
std::vector<std::uint8_t> crowded(const Geometry& geometry,
                                  const CoarseParticles& coarse,
                                  std::span<const double> strength,
                                  std::span<const std::uint8_t> burst,
                                  double spacing);

/// Opens a hole around the coarse particle `at`: marks those of its film within `radius`, and puts fine ones that are
/// there onto the hole's edge.
std::vector<std::uint8_t> open_hole(const CoarseParticles& coarse, FineParticles& fine, std::size_t at, double radius);

}  // namespace lamella::melp
