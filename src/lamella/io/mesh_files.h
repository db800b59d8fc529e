#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::io {

/// Films between two regions that are tenser than others.
struct PairTension {
    mesh::RegionId a, b;
    double factor = 1.0;
};

/// Films from a file, sound in the sense of mesh::require_sound. Lengths as in the file.
struct FilmFile {
    mesh::FoamMesh mesh;
    std::vector<PairTension> tensions;  ///< those that differ from 1, each pair once
};

/// Reads films from a Surface Evolver datafile, Wavefront OBJ or PLY, by the file's suffix.
/// @throws InputError  name and line or element, what was found   @throws IoError  it cannot be read
FilmFile read_films(const std::filesystem::path& path);

/// The same from memory (tests, fuzzing); the suffix of `name` says what it is, and `name` stands for the file in messages.
FilmFile parse_films(std::string_view contents, const std::string& name);

/// The bytes of such a file, at most 1 GiB. @throws InputError, IoError
std::string film_file_contents(const std::filesystem::path& path);

/// Whether a file of this name is one for read_films: .fe, .obj or .ply.
bool is_film_file(const std::filesystem::path& path);

/// Surface Evolver datafile: sections vertices, edges, faces, bodies; fixed, volumes, tensions, tori with wraps, curves of
/// one parameter, constant expressions. Bodies keep their numbers as regions, closed where they have a volume; sides of
/// faces that no body has are found by mesh::label_sides. Faces with more than three edges become a fan around their
/// middle, as in the Evolver. What is fixed is on a wire.
/// @throws InputError  also every keyword that is not understood, by its name
FilmFile parse_surface_evolver(std::string_view text, const std::string& name);

/// Wavefront OBJ: vertices and faces. Groups film_B_F give the regions behind and in front, points of the group `wire` are
/// held; without such groups every cell that films close in becomes a bubble, and every edge with one face is on a wire.
FilmFile parse_obj(std::string_view text, const std::string& name);

/// PLY, text or binary little endian: vertices and faces. Properties region_back, region_front of faces and on_wire of
/// vertices are used where they are there; without labels as for OBJ.
FilmFile parse_ply(std::string_view contents, const std::string& name);

}  // namespace lamella::io
