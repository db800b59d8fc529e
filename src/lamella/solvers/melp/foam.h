#pragma once

#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/particles.h"

#include <cstddef>
#include <cstdint>
#include <vector>

// How the bubbles of a foam share films, and what becomes of these when one bursts.

namespace lamella::melp {

/// Area of the film that region `r` shares with each region, itself for what it shares with the outside [m^2].
std::vector<double> shared_film(const CoarseParticles& coarse,
                                const Geometry& geometry,
                                std::size_t regions,
                                std::size_t r);

/// How much of the film of other regions lies where a particle does: their sum a W, per region, none left out.
struct Share {
    std::int32_t region;
    double gamma;
};
std::vector<Share> shares_at(const CoarseParticles& coarse, const Geometry& geometry, std::size_t i);

/// Coarse particles on the film between two regions [1: yes]: those of each on which the other's film lies.
std::vector<std::uint8_t> on_partition(const CoarseParticles& coarse,
                                       const Geometry& geometry,
                                       std::size_t a,
                                       std::size_t b);

/// Gives the fine particles of region `r` to the regions whose films lie where they are, and marks those that lie in a
/// film with the outside. @returns [1: marked]
std::vector<std::uint8_t> hand_over(const CoarseParticles& coarse,
                                    const Geometry& geometry,
                                    std::size_t r,
                                    FineParticles& fine);

/// Puts fine particles of the regions a and b whose nearest coarse particle is marked beside the nearest that stays:
/// the liquid of a partition that bursts goes to its border.
void gather_on_border(const CoarseParticles& coarse,
                      const std::vector<std::uint8_t>& marked,
                      std::size_t a,
                      std::size_t b,
                      double spacing,
                      FineParticles& fine);

/// Coarse particles whose normal disagrees with more of those next to them in their film than it agrees with, and all
/// of a closed film that encloses less than nothing. None should.
std::size_t flipped_normals(const CoarseParticles& coarse,
                            const Geometry& geometry,
                            const std::vector<Gas>& gas,
                            double spacing);

}  // namespace lamella::melp
