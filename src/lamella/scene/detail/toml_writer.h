#pragma once

#include "lamella/sim/node.h"

#include <functional>
#include <string>
#include <string_view>

namespace lamella::scene::detail {

/// What stands behind a line of a written table: the comment for a key's dotted name relative to the table
/// ("flow.velocity"); "" for none.
using CommentOf = std::function<std::string(std::string_view name)>;

/// A table as TOML that reads back exactly: `[name]`, its values one per line, then its tables as `[name.key]`.
/// @param name  "" writes the values without a heading
std::string toml_text(std::string_view name, const sim::Node& table, const CommentOf& comment_of);

/// A value on one line.
std::string toml_value_text(const sim::Node& value);

}  // namespace lamella::scene::detail
