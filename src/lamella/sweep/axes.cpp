#include "lamella/sweep/axes.h"

#include "lamella/core/error.h"
#include "lamella/scene/toml_file.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

namespace lamella::sweep {
namespace {

constexpr double kMostValues = 1e6;

using Entry = std::pair<std::string, const sim::Node*>;

bool is_range(const sim::Node& node) { return node.find("from") != nullptr; }

/// Every value below a table with its dotted key; ranges count as values.
void collect(const sim::Node& table, const std::string& prefix, std::vector<Entry>& found) {
    for (const auto& [key, node] : *table.table()) {
        const std::string name = prefix.empty() ? key : prefix + "." + key;
        if (node.table() != nullptr && !is_range(node))
            collect(node, name, found);
        else
            found.emplace_back(name, &node);
    }
}

std::vector<Entry> entries(const sim::Node& table, const char* what) {
    if (table.table() == nullptr)
        throw InputError(table.where,
                         fmt::format("{} is {}; a table [{}] is needed", what, sim::type_name(table), what));
    std::vector<Entry> found;
    collect(table, "", found);
    return found;
}

double number(const sim::Node& range, const char* name) {
    const sim::Node* node = range.find(name);
    if (node != nullptr) {
        if (const auto* whole = std::get_if<std::int64_t>(&node->value)) return static_cast<double>(*whole);
        if (const auto* real = std::get_if<double>(&node->value); real != nullptr && std::isfinite(*real)) return *real;
    }
    throw InputError(range.where, fmt::format("{}.{} is {}; a number is needed", range.path, name,
                                              node != nullptr ? sim::found_text(*node) : "missing"));
}

bool whole(const sim::Node& range, const char* name) {
    return std::holds_alternative<std::int64_t>(range.find(name)->value);
}

/// from, from + step, ... to, each rounded to twelve digits: 0.83, not 0.8300000000000001.
std::vector<std::string> range_values(const sim::Node& range) {
    for (const auto& [key, node] : *range.table())
        if (key != "from" && key != "to" && key != "step")
            throw InputError(node.where, fmt::format("{} is no part of a range; known are from, to, step", node.path));
    const double from = number(range, "from"), to = number(range, "to"), step = number(range, "step");
    const double steps = step != 0.0 ? (to - from) / step : -1.0;
    if (!(steps >= 0.0) || steps >= kMostValues)
        throw InputError(range.where,
                         fmt::format("{} goes from {} to {} by {}; a step that gets there in less than {:.0e} "
                                     "steps is needed",
                                     range.path, from, to, step, kMostValues));
    const bool integers = whole(range, "from") && whole(range, "step");
    std::vector<std::string> values;
    constexpr double kRounding = 1e-9;  // of a step: the last one counts though it was not hit exactly
    for (int k = 0; k <= static_cast<int>(std::floor(steps + kRounding)); ++k) {
        const double value = from + k * step;
        const double rounded = std::stod(fmt::format("{:.12g}", value));
        values.push_back(integers ? fmt::format("{}", std::llround(value)) : sim::exact_text(rounded));
    }
    return values;
}

std::vector<std::string> values_of(const sim::Node& node) {
    if (node.table() != nullptr) return range_values(node);
    const sim::Node::Array* list = node.array();
    if (list == nullptr || list->empty())
        throw InputError(node.where,
                         fmt::format("{} = {} does not vary; give a list of values, or {{ from = .., to = .., "
                                     "step = .. }}; what stays the same belongs to [set]",
                                     node.path, sim::found_text(node)));
    std::vector<std::string> values;
    for (const sim::Node& item : *list) values.push_back(scene::toml_value(item));
    return values;
}

}  // namespace

std::vector<Axis> read_axes(const sim::Node& table) {
    std::vector<Axis> axes;
    for (const auto& [key, node] : entries(table, "axes")) {
        Axis axis{{key}, {}};
        for (std::string& value : values_of(*node)) axis.values.push_back({std::move(value)});
        axes.push_back(std::move(axis));
    }
    return axes;
}

Axis read_zip(const sim::Node& table) {
    Axis axis;
    for (const auto& [key, node] : entries(table, "zip")) {
        const std::vector<std::string> values = values_of(*node);
        if (axis.keys.empty()) axis.values.resize(values.size());
        if (values.size() != axis.values.size())
            throw InputError(node->where,
                             fmt::format("{} has {} values and {} has {}; keys that vary together have as many", key,
                                         values.size(), axis.keys.front(), axis.values.size()));
        axis.keys.push_back(key);
        for (std::size_t i = 0; i < values.size(); ++i) axis.values[i].push_back(values[i]);
    }
    if (axis.keys.empty()) throw InputError(table.where, "a [[zip]] without keys");
    return axis;
}

std::vector<std::pair<std::string, std::string>> read_set(const sim::Node& table) {
    std::vector<std::pair<std::string, std::string>> set;
    for (const auto& [key, node] : entries(table, "set")) set.emplace_back(key, scene::toml_value(*node));
    return set;
}

}  // namespace lamella::sweep
