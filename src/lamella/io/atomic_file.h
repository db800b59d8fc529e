#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace lamella::io {

/// Writes a whole file under a temporary name in the same folder (`<path>.tmp`), syncs it, and renames it into
/// place. A file that is there already is replaced; a folder or device in its place is an error.
/// @throws IoError  naming the path and the system's reason; nothing is left behind
void write_file_atomically(const std::filesystem::path& path, std::string_view contents);

/// The contents of a file of at most `limit` bytes.
/// @throws IoError  it cannot be read   @throws InputError  it is larger, or a directory
std::string read_file(const std::filesystem::path& path, std::size_t limit = std::size_t{1} << 30);

/// The shortest text that reads back as the same double; "nan", "inf" and "-inf" as such.
std::string shortest_text(double value);
/// The same, appended to `out`.
void append_shortest(std::string& out, double value);

}  // namespace lamella::io
