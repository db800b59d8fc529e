#pragma once

#include <cstdint>
#include <optional>

#include "lamella/film/problem.h"
#include "lamella/mesh/foam_mesh.h"

namespace lamella::film {

/// The region that shares most film with `region`, or nothing where it has no film.
std::optional<mesh::RegionId> largest_neighbor(const mesh::FoamMesh& mesh, mesh::RegionId region);

/// Whether two regions have a film between them, which could burst.
bool share_film(const mesh::FoamMesh& mesh, mesh::RegionId a, mesh::RegionId b);

/// A bubble drawn at random among those that touch the outside, all with the same probability; nothing when none does.
/// @param draw  which draw of the run this is: the same seed and draw give the same bubble
std::optional<mesh::RegionId> random_outer_bubble(const mesh::FoamMesh& mesh, std::uint64_t seed, std::uint64_t draw);

/// @throws InputError  the scene has an [[event]] of kind "puncture", a [[wall]] or a [[faucet]], which `solver` does
/// not know
void refuse_what_melp_alone_knows(const Problem& films, const char* solver);

}  // namespace lamella::film
