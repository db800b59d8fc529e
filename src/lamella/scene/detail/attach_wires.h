#pragma once

#include "lamella/scene/film_tables.h"
#include "lamella/sim/node.h"

namespace lamella::scene::detail {

/// Adds the wires of a scene to its films: puts films near a wire onto it, and notes which wire holds which vertex.
/// @param root  the whole scene  @throws InputError  a wire that holds nothing, or that is none
void attach_wires(film::Problem& problem, const FilmTables& tables, const sim::Node& root);

}  // namespace lamella::scene::detail
