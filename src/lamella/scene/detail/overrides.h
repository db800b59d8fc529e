#pragma once

#include "lamella/sim/node.h"

#include <string>

namespace lamella::scene::detail {

/// Sets one value of a scene from the command line: "bubble.gas_fraction=0.9". What stands behind '=' is a TOML value,
/// or a string when it is none. Tables on the way are made as needed.
/// @throws InputError  no '=', an empty part in the key, a key below a value, text that is not UTF-8
void apply_override(sim::Node& root, const std::string& assignment);

}  // namespace lamella::scene::detail
