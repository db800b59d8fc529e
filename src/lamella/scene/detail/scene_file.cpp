#include "lamella/scene/detail/scene_file.h"

#include "lamella/core/error.h"
#include "lamella/scene/detail/toml_reader.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace lamella::scene::detail {

std::string read_scene_file(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::is_directory(path, unreadable))
        throw InputError({path.string(), 0, 0}, "is a directory; a file is expected");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw IoError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
    // One byte more than allowed tells that there is more, also for pipes and devices, which have no size.
    std::string text(kLargestScene + 1, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (file.bad()) throw IoError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    text.resize(static_cast<std::size_t>(file.gcount()));
    return text;
}

}  // namespace lamella::scene::detail
