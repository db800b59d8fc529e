#pragma once

// Balls and sticks in films.

#include "lamella/film/solid.h"
#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/open_films.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/rims.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella::melp {

/// Adds what wet solids that are in the films hold of each film that has a rim: pieces after those of the rims.
void append_solids(std::span<const film::Body> bodies, std::span<const Gas> gas, std::vector<RimPiece>& rims);

/// Takes points out that lie in a wet solid: films start around it.
void cut_out(std::span<const film::Body> bodies, Sample& sample);

/// What films do to wet solids: the tension 2 sigma of a film along a loop through the particles nearest to the solid,
///
///   F = sum over the loop of 2 sigma dl x n,
///
/// which is the same for every loop around it where the film is at rest, and has no noise in the film's plane. Writes
/// body.force [N]; nothing where a film does not surround the solid. Films without weight and gas between the loop and
/// the solid, and no torque: films slide.
void pull_solids(const CoarseParticles& coarse,
                 const Geometry& geometry,
                 std::span<const double> interface_tension,
                 double spacing,
                 std::span<film::Body> bodies);

/// A coarse particle that touches a dry solid, of those in films that have not burst; nothing where none does.
std::optional<std::size_t> touching(std::span<const film::Body> bodies,
                                    const CoarseParticles& coarse,
                                    std::span<const Gas> gas);

}  // namespace lamella::melp
