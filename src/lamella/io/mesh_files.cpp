#include "lamella/io/mesh_files.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace lamella::io {
namespace {

using Parser = FilmFile (*)(std::string_view contents, const std::string& name);

Parser parser_for(const std::filesystem::path& path) {
    std::string suffix = path.extension().string();
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (suffix == ".fe") return parse_surface_evolver;
    if (suffix == ".obj") return parse_obj;
    if (suffix == ".ply") return parse_ply;
    return nullptr;
}

constexpr std::size_t kLargestFile = std::size_t{1} << 30;

void require_film_file(const std::string& name) {
    if (!is_film_file(name)) throw InputError({name, 0, 0}, "is no file of films; .fe, .obj and .ply are");
}

}  // namespace

bool is_film_file(const std::filesystem::path& path) { return parser_for(path) != nullptr; }

/// In pieces, so that a file without end (/dev/zero) or of a false size takes no more memory than it has bytes.
std::string film_file_contents(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::is_directory(path, unreadable))
        throw InputError({path.string(), 0, 0}, "is a directory; a file is expected");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw IoError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    std::string contents;
    while (file) {
        const std::size_t before = contents.size();
        if (before > kLargestFile)
            throw InputError({path.string(), 0, 0}, fmt::format("is larger than {} MiB", kLargestFile >> 20));
        contents.resize(before + kPiece);
        file.read(contents.data() + before, kPiece);
        contents.resize(before + static_cast<std::size_t>(file.gcount()));
    }
    if (file.bad()) throw IoError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    return contents;
}

FilmFile parse_films(std::string_view contents, const std::string& name) {
    require_film_file(name);
    return parser_for(name)(contents, name);
}

FilmFile read_films(const std::filesystem::path& path) {
    require_film_file(path.string());
    return parse_films(film_file_contents(path), path.string());
}

}  // namespace lamella::io
