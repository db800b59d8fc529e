#pragma once

#include <filesystem>
#include <string>

namespace lamella::scene::detail {

/// The bytes of a file that the user named; pipes and devices will do. Reads no more than one byte beyond
/// kLargestScene, which the reader of the text then refuses.
/// @throws InputError  a directory   @throws IoError  it cannot be opened or read
std::string read_scene_file(const std::filesystem::path& path);

}  // namespace lamella::scene::detail
