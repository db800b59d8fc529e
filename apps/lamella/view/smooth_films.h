#pragma once

#include "lamella/sim/frame.h"

#include "view/film_parts.h"
#include <array>
#include <cstdint>
#include <vector>

namespace lamella::app::view {

/// Films as so many triangles that they look smooth, for the graphics card.
struct SmoothFilms {
    struct Vertex {
        Vec3 position;
        Vec3 normal;  ///< unit length, pointing into the larger of the two regions
        std::array<std::int32_t, 2> regions{};
        std::array<std::uint32_t, 3> sources{};  ///< the frame's vertices that it lies between
        std::array<double, 3> weights{};         ///< of them
    };
    using Segment = std::array<Vec3, 2>;

    std::vector<Vertex> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> face;  ///< of each triangle: the frame's triangle that it is a piece of
    std::vector<Segment> borders, wires;
};

/// The films with each triangle in `pieces` x `pieces` pieces, the lines with each edge in `pieces`.
///
/// Pieces lie on a cubic patch over the triangle: the frame's own quadratic triangle where it has one
/// (sim::kCurvedNodes), else the patch that the normals of its corners give [Vlachos01]. Edges of borders and wires are
/// cubics that pass their vertices without a kink unless there is a corner or a junction, the same for all films that
/// meet there. One piece: the triangles as they are.
SmoothFilms smooth_films(const sim::Surface& surface, const FilmParts& parts, int pieces);

}  // namespace lamella::app::view
