#pragma once

#include "lamella/sim/node.h"

#include <string>
#include <string_view>

namespace lamella::scene::detail {

/// JSON as found in theses: beside standard JSON, a comma between two members may be missing and strings may go on over
/// line ends (read as one space). Values remember their line.
///
/// @param name  of the file, for messages
/// @throws InputError  with file:line: syntax, bad UTF-8, a key given twice, more than 32 levels, numbers that do not
///                     fit; the outermost value is not an object
sim::Node read_lenient_json(std::string_view text, const std::string& name);

/// Whether `text` is valid UTF-8 (no surrogates, no overlong forms).
bool is_utf8(std::string_view text);

}  // namespace lamella::scene::detail
