#include "lamella/scene/shipped.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/scene/detail/scene_file.h"
#include "lamella/scene/detail/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <system_error>

namespace lamella::scene {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> scene_folders() {
    std::vector<fs::path> folders;
    if (const char* chosen = std::getenv("LAMELLA_SCENES"); chosen != nullptr && *chosen != '\0')
        folders.emplace_back(chosen);
#ifdef LAMELLA_SCENE_DIR_SOURCE
    folders.emplace_back(LAMELLA_SCENE_DIR_SOURCE);
#endif
#ifdef LAMELLA_SCENE_DIR_INSTALL
    folders.emplace_back(LAMELLA_SCENE_DIR_INSTALL);
#endif
    return folders;
}

/// Name -> file of every scene. A folder that does not exist has none: a build need not be installed, and an installed
/// program need not have its sources.
std::map<std::string, fs::path> scene_files() {
    std::map<std::string, fs::path> files;
    for (const fs::path& folder : scene_folders()) {
        std::error_code failed;
        for (fs::recursive_directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
            std::error_code unreadable;
            if (it->path().extension() != ".toml" || !it->is_regular_file(unreadable)) continue;
            files.emplace(it->path().lexically_relative(folder).replace_extension().generic_string(), it->path());
        }
    }
    return files;
}

std::string title_of(const fs::path& path) {
    try {
        const sim::Node root = detail::read_toml(detail::read_scene_file(path), path.string());
        const sim::Node* title = root.find("title");
        const auto* text = title != nullptr ? std::get_if<std::string>(&title->value) : nullptr;
        return text != nullptr ? *text : "(no title)";
    } catch (const std::runtime_error& problem) {
        return fmt::format("(cannot be read: {})", problem.what());
    }
}

std::string last_part(const std::string& name) { return name.substr(name.rfind('/') + 1); }

/// A shipped scene that `name` is near to, with or without its folder.
std::optional<std::string> near_name(const std::string& name, const std::map<std::string, fs::path>& files) {
    std::vector<std::string> names, short_names;
    for (const auto& [known, path] : files) {
        names.push_back(known);
        short_names.push_back(last_part(known));
    }
    const auto position = [](const std::vector<std::string>& list, const std::string& word) {
        return static_cast<std::size_t>(std::find(list.begin(), list.end(), word) - list.begin());
    };
    if (const std::size_t at = position(short_names, last_part(name)); at < names.size()) return names[at];
    if (const auto near = nearest_word(name, names)) return near;
    if (const auto near = nearest_word(last_part(name), short_names)) return names[position(short_names, *near)];
    return std::nullopt;
}

}  // namespace

std::vector<ShippedScene> shipped_scenes() {
    std::vector<ShippedScene> scenes;
    for (const auto& [name, path] : scene_files()) scenes.push_back({name, title_of(path), path});
    return scenes;
}

fs::path resolve_scene_path(const std::string& name) {
    std::error_code unreadable;
    if (fs::exists(name, unreadable)) return name;
    const std::map<std::string, fs::path> files = scene_files();
    const std::string bare = name.ends_with(".toml") ? name.substr(0, name.size() - 5) : name;
    if (const auto it = files.find(bare); it != files.end()) return it->second;
    const auto near = near_name(bare, files);
    throw InputError(fmt::format("{} is neither a file nor the name of a shipped scene; {}", sim::quoted_text(name),
                                 near ? fmt::format("did you mean {}?", *near) : "`lamella scenes` lists them"));
}

}  // namespace lamella::scene
