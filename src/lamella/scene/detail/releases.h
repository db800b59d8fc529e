#pragma once

#include "lamella/scene/film_tables.h"
#include "lamella/sim/node.h"

#include <cstdint>

namespace lamella::scene::detail {

/// Adds the bubbles that faucets let in: regions without faces behind those of the mesh, in order of time.
/// @param root  the whole scene
void add_releases(film::Problem& problem, const FilmTables& tables, const sim::Node& root, std::uint64_t seed);

}  // namespace lamella::scene::detail
