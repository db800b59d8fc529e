#pragma once

#include "lamella/sim/frame.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella::io::detail {

/// A part of a frame for programs that draw: a film between two regions, all balls or all solids as polyhedra.
struct DrawnPart {
    std::string name;                             ///< "film_1_0": region 1 behind, 0 in front; "bubbles"; "solids"
    std::array<std::int32_t, 2> regions{-1, -1};  ///< of a film
    std::vector<std::uint32_t> source;            ///< of each vertex: the surface's vertex, the ball, the solid
    std::span<const sim::Field> fields;           ///< of what `source` counts
    std::vector<Vec3> position;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< empty: just points
    std::vector<Vec3> normal;                             ///< of balls; films have theirs in a field
};

/// The films in the order of their regions, then the points, then the solids.
std::vector<DrawnPart> drawn_parts(const sim::Frame& frame);

/// The part's values of a field, which belongs to the vertices that `source` counts.
std::vector<double> part_values(const DrawnPart& part, const sim::Field& field);

/// From sRGB of 8 bits to linear light, 0 to 1.
double linear_light(double encoded);

}  // namespace lamella::io::detail
