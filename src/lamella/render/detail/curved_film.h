#pragma once

#include "lamella/render/detail/film_patches.h"

#include <array>
#include <vector>

namespace lamella::render::detail {

/// Films as triangles so fine that they look smooth.
struct FineFilms {
    std::vector<std::array<float, 3>> position;  ///< shared by the pieces of one coarse triangle
    std::vector<std::array<float, 3>> normal;    ///< unit, per position
    std::vector<float> value;                    ///< per position: what the corners' values interpolate to
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::uint32_t> coarse;  ///< of each triangle: the triangle of the patches it is part of
};

/// A chain of points on borders or wires.
struct Thread {
    std::vector<Vec3> points;
    bool wire = false;
    bool rim = false;  ///< a film ends here, on nothing
};

/// Replaces each triangle by the cubic patch of [Vlachos01] over its corners and normals, cut into n x n pieces. An
/// edge at a border follows the border's own curve (a cubic through its points), so that the films that meet there
/// still meet.
///
/// @param value  of the three corners of each triangle
FineFilms refine_films(const FilmPatches& patches, const std::vector<std::array<double, 3>>& value, int pieces);

/// The borders and wires as such curves, each edge cut into `pieces`.
std::vector<Thread> refine_borders(const FilmPatches& patches, int pieces);

}  // namespace lamella::render::detail
