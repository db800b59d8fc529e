#pragma once

#include "lamella/sim/node.h"

#include <string>
#include <vector>

namespace lamella::sweep {

/// Keys of a scene that vary together, and the values that they take.
struct Axis {
    std::vector<std::string> keys;                 ///< "bubble.gas_fraction"; more than one where they are zipped
    std::vector<std::vector<std::string>> values;  ///< [step][key], as TOML
};

/// The axes of a table [axes]: each key, dotted or in tables, has a list of values, or a table of from, to and step.
/// @throws InputError  a key without values, a step that does not lead from `from` to `to`, more than 1e6 values
std::vector<Axis> read_axes(const sim::Node& table);

/// One axis of a table of [[zip]]: lists of the same length.
/// @throws InputError  as read_axes; lists of different lengths
Axis read_zip(const sim::Node& table);

/// Key and value of every entry of [set], in the order of the file.
std::vector<std::pair<std::string, std::string>> read_set(const sim::Node& table);

}  // namespace lamella::sweep
