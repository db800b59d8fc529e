#pragma once

#include "lamella/core/error.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace lamella::sim {

/// A value of a scene file together with where it stands there, free of any file format.
struct Node {
    using Array = std::vector<Node>;
    using Table = std::vector<std::pair<std::string, Node>>;  ///< in the order of the file

    using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table>;

    Node() = default;
    Node(Value v, SourceLocation place = {}, std::string name = {})
        : value(std::move(v)), where(std::move(place)), path(std::move(name)) {}

    Value value;
    SourceLocation where;
    std::string path;  ///< "bubble.flow.velocity"; "" for the whole file

    const Table* table() const { return std::get_if<Table>(&value); }
    const Array* array() const { return std::get_if<Array>(&value); }
    /// The entry `key` of a table, or nullptr (also when this is not a table).
    const Node* find(std::string_view key) const;
    Node* find(std::string_view key);
    /// Sets or adds the entry `key` of a table.
    Node& set(std::string_view key, Node entry);
};

/// "a string", "an integer", "a table" ...: how error messages name a value's type.
std::string type_name(const Node& node);

/// The value as the user would write it in TOML, shortened to one line: for error messages.
std::string found_text(const Node& node);

/// `text` as a quoted TOML string on one line; what cannot be printed is escaped.
std::string quoted_text(std::string_view text);

/// The shortest number that reads back as the same double, always a TOML float: "0.1", "1.0", "1e-05".
std::string exact_text(double value);

/// `key` as TOML writes it: bare where that is allowed, quoted otherwise.
std::string key_text(std::string_view key);

/// "bubble" and "flow" -> "bubble.flow"; "" and "bubble" -> "bubble".
std::string join_path(std::string_view parent, std::string_view key);

}  // namespace lamella::sim
