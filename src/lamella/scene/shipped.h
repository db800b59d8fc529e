#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lamella::scene {

/// A scene that comes with lamella.
struct ShippedScene {
    std::string name;   ///< "bubble/coarsening-2d-small": its path below the folder of scenes, without .toml
    std::string title;  ///< what the file says, or why it cannot be read
    std::filesystem::path path;
};

/// Every shipped scene, sorted by name. Looked for in $LAMELLA_SCENES, in the source tree that this was built from, and
/// where lamella was installed; a name found twice is the first one's.
std::vector<ShippedScene> shipped_scenes();

/// The file that the user means: a path that exists, or the name of a shipped scene with or without ".toml".
/// @throws InputError  neither; with the nearest shipped name
std::filesystem::path resolve_scene_path(const std::string& name);

}  // namespace lamella::scene
