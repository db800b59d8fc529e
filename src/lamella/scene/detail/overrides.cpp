#include "lamella/scene/detail/overrides.h"

#include "lamella/core/error.h"
#include "lamella/scene/detail/toml_reader.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

namespace lamella::scene::detail {
namespace {

constexpr std::size_t kLongestKey = 200;

std::vector<std::string> parts_of(std::string_view key, const SourceLocation& where) {
    while (key.ends_with(' ')) key.remove_suffix(1);  // "seed = 3" in quotes
    std::vector<std::string> parts(1);
    for (const char c : key) {
        if (c == '.')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    for (const std::string& part : parts)
        if (sim::key_text(part) != part || key.size() > kLongestKey)
            throw InputError(where, "the key must be names joined by dots, as in bubble.gas_fraction=0.9");
    return parts;
}

sim::Node value_of(std::string_view text, const SourceLocation& where) {
    if (auto value = read_toml_value(text)) return *value;
    if (auto words = read_toml_value(sim::quoted_text(text))) return *words;
    throw InputError(where, "the value is not UTF-8 text, or longer than a scene may be");
}

/// Where messages about a value and everything in it point.
void set_place(sim::Node& node, const SourceLocation& where, const std::string& path) {
    node.where = where;
    node.path = path;
    if (auto* items = std::get_if<sim::Node::Array>(&node.value))
        for (std::size_t i = 0; i < items->size(); ++i) set_place((*items)[i], where, fmt::format("{}[{}]", path, i));
    if (auto* entries = std::get_if<sim::Node::Table>(&node.value))
        for (auto& [key, entry] : *entries) set_place(entry, where, sim::join_path(path, key));
}

}  // namespace

void apply_override(sim::Node& root, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    sim::Node shown{assignment.size() > 60 ? assignment.substr(0, equals) + "=..." : assignment, {}, {}};
    const std::string quoted = sim::found_text(shown);
    const SourceLocation where{"--set " + quoted.substr(1, quoted.size() - 2), 0, 0};
    if (equals == std::string::npos) throw InputError(where, "there is no '='; write key=value");

    const std::vector<std::string> parts = parts_of(std::string_view(assignment).substr(0, equals), where);
    sim::Node value = value_of(std::string_view(assignment).substr(equals + 1), where);
    sim::Node* table = &root;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        sim::Node* next = table->find(parts[i]);
        if (next == nullptr)
            next = &table->set(parts[i], {sim::Node::Table{}, where, sim::join_path(table->path, parts[i])});
        if (next->table() == nullptr)
            throw InputError(where, fmt::format("{} is {}, not a table", next->path, sim::type_name(*next)));
        table = next;
    }
    set_place(value, where, sim::join_path(table->path, parts.back()));
    table->set(parts.back(), std::move(value));
}

}  // namespace lamella::scene::detail
