#pragma once

#include "lamella/sim/node.h"

#include <optional>
#include <string>
#include <string_view>

namespace lamella::scene::detail {

/// Text larger than this is no scene.
inline constexpr std::size_t kLargestScene = std::size_t{1} << 20;

/// The tables and values of a TOML text, each with its line, entries in the order of the text.
///
/// @param name  of the file, for messages
/// @throws InputError  with file:line: syntax, bad UTF-8, control characters, a key given twice, tables nested too
///                     deeply, dates, more than kLargestScene bytes
sim::Node read_toml(std::string_view text, const std::string& name);

/// A single TOML value ("0.9", "[1, 2]", "\"text\""), or nothing when `text` is none.
std::optional<sim::Node> read_toml_value(std::string_view text);

}  // namespace lamella::scene::detail
