#pragma once

#include "lamella/sim/frame.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::app::view {

/// The films of a frame cut apart along their borders, as a graphics card wants them: a vertex where three films meet
/// becomes three, one per film, each with the normal of its own film.
struct FilmParts {
    struct Vertex {
        std::uint32_t source = 0;               ///< the frame's vertex
        std::array<std::int32_t, 2> regions{};  ///< of its film, the smaller first
        Vec3 normal;                            ///< unit length, pointing into the larger of the two regions
    };
    using Ends = std::array<std::uint32_t, 2>;  ///< places of an edge, the smaller first

    std::vector<Vertex> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< in the frame's order
    std::vector<std::uint32_t> place;                     ///< of the frame's vertices: the first one at the same place
    std::vector<Ends> borders;  ///< edges where three films or more meet, or one ends without a wire; ascending
    std::vector<Ends> wires;    ///< edges that hold a film: its rim, or a wire through films; ascending
};

/// Vertices at the same place count as one, so that a periodic foam, whose triangles share none, has borders too.
/// @throws InputError  a triangle names a vertex that is not there, or regions are missing (a damaged frame)
FilmParts film_parts(const sim::Surface& surface);

}  // namespace lamella::app::view
