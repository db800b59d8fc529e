#pragma once

#include "lamella/sim/frame.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::render::detail {

/// An edge where films meet or end: part of a Plateau border or of a rim.
struct BorderEdge {
    std::array<std::uint32_t, 2> ends;  ///< points
    int films = 0;                      ///< triangles at the edge
    bool on_wire = false;               ///< both ends are held
};

/// The films of a frame cut along their borders into smooth pieces: a corner is one point of one film, with one normal.
struct FilmPatches {
    std::vector<Vec3> point;                              ///< places in space; equal ones are one
    std::vector<std::uint32_t> corner_point;              ///< of each corner
    std::vector<Vec3> corner_normal;                      ///< unit; to the side of the region with the larger number
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three corners, all of one film
    std::vector<std::uint32_t> source;                    ///< of each triangle: its number in the frame
    std::vector<std::array<std::uint32_t, 3>> source_corner;  ///< of each triangle: the frame's vertices
    std::vector<std::uint32_t> film;  ///< of each triangle: which pair of regions it parts, 0, 1, ...
    std::vector<BorderEdge> borders;
};

/// @throws InputError  triangles that refer to missing vertices, places that are not finite
FilmPatches film_patches(const sim::Surface& surface);

}  // namespace lamella::render::detail
