#pragma once

#include "lamella/core/vec.h"
#include "lamella/io/mesh_files.h"
#include "lamella/mesh/foam_mesh.h"

#include <filesystem>

namespace lamella::scene::detail {

/// Films of a file, `scale` times as large as there, then moved by `center` [m].
/// @throws InputError  what the reader complains about; no file   @throws IoError
io::FilmFile scaled_films(const std::filesystem::path& path, double scale, const Vec3& center);

/// The edge length of a scene that says none: a quarter of the smallest bubble's radius, or a twentieth of the largest side
/// of the films' box [m].
double edge_length_for(const mesh::FoamMesh& mesh);

/// Cuts faces into four until the mean edge is no longer than 1.5 `edge_length`, then single edges on wires, which trackers
/// leave alone, to 1.45 of it. New places on wires are those of mesh::edge_middles: wires are smooth where they turn by
/// less than 60 degrees. @throws InputError  this would give more than 20 million faces
void refine_films(mesh::FoamMesh& mesh, double edge_length);

}  // namespace lamella::scene::detail
