#pragma once

#include "lamella/solvers/melp/rims.h"
#include "lamella/solvers/melp/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// The strips of film between the outermost particles and the rims that hold them.
struct FilmEnds {
    /// A point of a rim.
    struct Foot {
        Vec3 position;           ///< [m]
        std::uint32_t particle;  ///< near it: the film there is as this one has it
        std::uint32_t piece;     ///< of the rims
    };
    std::vector<Foot> feet;
    Triangles triangles;  ///< of particles, then feet: indices from the number of particles on
};

/// Particles keep a distance from rims, so triangles between them end before it, in a ragged line. Each edge that is
/// open there is joined to the nearest points of the rims by two triangles, around a corner of two wires by three.
/// @param triangles  between particles
/// @param reach      how far from a rim ends belong to it; others are the edges of holes [m]
FilmEnds film_ends(const CoarseParticles& coarse,
                   const Triangles& triangles,
                   std::span<const RimPiece> rims,
                   double reach);

}  // namespace lamella::melp
