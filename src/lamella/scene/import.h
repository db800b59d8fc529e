#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lamella::scene {

/// A scene made from the input file of another program for the same model: the JSON of [Lankinen20, Listing A.1] (as
/// printed, with its missing comma and broken strings) or of cubble.
///
/// The scene poses the same problem; how lamella solves it is lamella's own default, and comments on top say which
/// options reproduce the published program, what was assumed and which keys have no meaning here.
///
/// @returns  the text of the scene
/// @throws InputError  with file:line: syntax, a value of the wrong type or out of range, a file that is neither of the
///                     two   @throws IoError
std::string import_foam_json(const std::filesystem::path& path);

/// The same from text; `name` stands for the file in messages.
std::string import_foam_json_text(std::string_view text, const std::string& name);

/// A scene for the solver equilibrium that starts from the films of a Surface Evolver datafile, OBJ or PLY.
/// @param folder  where the scene will be: it names the file as seen from there; empty: by its absolute name
/// @throws InputError  the file is no mesh of films (line or element and what is wrong)   @throws IoError
std::string import_films(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace lamella::scene
