#include "lamella/scene/toml_file.h"

#include "lamella/scene/detail/scene_file.h"
#include "lamella/scene/detail/toml_reader.h"
#include "lamella/scene/detail/toml_writer.h"

namespace lamella::scene {

sim::Node read_toml_file(const std::filesystem::path& path) {
    return detail::read_toml(detail::read_scene_file(path), path.string());
}

std::string toml_value(const sim::Node& value) { return detail::toml_value_text(value); }

}  // namespace lamella::scene
