#pragma once

#include "lamella/sim/node.h"

#include <filesystem>
#include <string>

namespace lamella::scene {

/// The tables and values of a TOML file, each with its line, in the order of the file: for files beside scenes.
/// @throws InputError  with file:line: no TOML, or larger than a scene may be   @throws IoError
sim::Node read_toml_file(const std::filesystem::path& path);

/// A value on one line, as load_scene takes it behind the '=' of an override.
std::string toml_value(const sim::Node& value);

}  // namespace lamella::scene
