#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::app {

/// Writes a result to standard output. A reader that went away (`lamella scenes | head -1`) is no error.
/// @throws IoError  it cannot be written, for instance because the disk behind it is full
void print_result(std::string_view text);

/// Writes to standard output where `path` is "-", otherwise to the file, which appears when it is whole.
/// @throws IoError
void write_result(const std::string& path, const std::function<void(std::ostream&)>& write);

/// One line on standard error: "lamella: ...".
void print_error(std::string_view text);

/// A number as people read it: up to 6 digits, counts in full.
std::string number_text(double value);

/// Two columns, the first as wide as its longest entry, the second wrapped to `width` characters.
std::string two_columns(const std::vector<std::pair<std::string, std::string>>& rows, std::size_t width = 100);

}  // namespace lamella::app
