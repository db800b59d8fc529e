#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/light_image.h"

#include <fmt/format.h>

namespace lamella::io {

LightImage parse_light_image(std::string_view contents, const std::string& name) {
    const std::string suffix = std::filesystem::path(name).extension().string();
    if (suffix == ".hdr" || suffix == ".pic") return detail::parse_radiance(contents, name);
    if (suffix == ".exr") return detail::parse_exr(contents, name);
    throw InputError(fmt::format("{}: a picture of light ends in .hdr or .exr", name));
}

LightImage read_light_image(const std::filesystem::path& path) { return parse_light_image(read_file(path), path.string()); }

}  // namespace lamella::io
