#pragma once

#include "lamella/core/error.h"
#include "lamella/sim/node.h"

#include <fmt/format.h>

#include <string_view>

// Where the tables of a scene stand, for messages.

namespace lamella::scene::detail {

/// Of the k-th table of a list.
inline SourceLocation place(const sim::Node& root, std::string_view name, std::size_t k) {
    const sim::Node* node = root.find(name);
    if (node == nullptr) return root.where;
    const auto* items = node->array();
    return items != nullptr && k < items->size() ? (*items)[k].where : node->where;
}

/// Calls make() and puts the place of a table before what it complains about.
template <class Make>
auto at_table(const SourceLocation& where, std::string_view name, Make&& make) {
    try {
        return make();
    } catch (const InputError& error) {
        throw InputError(where, fmt::format("{}: {}", name, error.what()));
    }
}

}  // namespace lamella::scene::detail
