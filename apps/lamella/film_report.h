#pragma once

#include "lamella/measure/film_measures.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <optional>
#include <string>

namespace lamella::app {

/// Adds the measures of films to the object of `measure --json`: total_area, film_area{"a-b"}, regions[...],
/// edge_angles{...}, corner_angles{...}, film_curvature{"a-b"}, thickness{...}, volume_error, mesh{...}, methods{...}.
/// Angles in degrees. What is not known, and the radius of a flat film, is null.
void add_films(nlohmann::ordered_json& object,
               const measure::FilmMeasures& films,
               std::optional<std::size_t> intersections);

/// The same as people read it.
std::string film_table(const measure::FilmMeasures& films, std::optional<std::size_t> intersections);

}  // namespace lamella::app
