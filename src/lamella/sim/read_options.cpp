#include "lamella/sim/read_options.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/core/units.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

namespace lamella::sim {
namespace {

[[noreturn]] void refuse(const Node& node, const std::string& what) {
    throw InputError(node.where, fmt::format("{} = {} {}", node.path, found_text(node), what));
}

[[noreturn]] void refuse_type(const Node& node, std::string_view expected, const Doc& doc) {
    refuse(node, fmt::format("is {}; {} is expected ({})", type_name(node), expected, doc.text));
}

/// The unit of an option, or "" when it takes plain numbers only.
std::string unit_of(const Doc& doc, const ModelUnits& units) {
    if (doc.unit.empty() || doc.unit == "-") return {};
    std::string unit = doc.unit;
    for (const auto& [word, stands_for] :
         {std::pair{"length", &units.length}, std::pair{"mass", &units.mass}, std::pair{"time", &units.time}}) {
        for (std::size_t at = unit.find(word); at != std::string::npos; at = unit.find(word)) {
            if (stands_for->empty()) return {};
            unit.replace(at, std::string_view(word).size(), *stands_for);
        }
    }
    return unit;
}

/// A hint for the commonest slip with fractions.
std::string percentage_hint(double value, const Range& range) {
    const bool fraction = range.low >= 0.0 && range.high <= 2.0;
    if (!fraction || value <= range.high || value > 100.0 * range.high) return {};
    return fmt::format("; as a fraction, {} % is {}", value, value / 100.0);
}

void check_range(const Node& node, double value, const Range& range, const Doc& doc) {
    const bool low = range.low_open ? value > range.low : value >= range.low;
    const bool high = range.high_open ? value < range.high : value <= range.high;
    if (low && high) return;
    const bool bounded = std::isfinite(range.low) && std::isfinite(range.high);
    refuse(node, fmt::format("{} {} ({}){}", bounded ? "is outside" : "is not", range_text(range), doc.text,
                             percentage_hint(value, range)));
}

double read_number(const Node& node, const Doc& doc, const std::string& unit) {
    if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return static_cast<double>(*whole);
    if (const auto* number = std::get_if<double>(&node.value)) {
        if (!std::isfinite(*number)) refuse(node, fmt::format("is not a finite number ({})", doc.text));
        return *number;
    }
    const auto* text = std::get_if<std::string>(&node.value);
    if (text == nullptr) refuse_type(node, "a number", doc);
    if (unit.empty())
        refuse(node, fmt::format("is a string; a plain number without unit is expected ({}{})", doc.text,
                                 doc.unit == "-" ? "" : fmt::format("; in the solver's own unit, {}", doc.unit)));
    try {
        return parse_quantity(*text, unit);
    } catch (const InputError& problem) {
        throw InputError(node.where, fmt::format("{} = {}", node.path, problem.what()));
    }
}

/// A whole number within what the option's integer type can hold.
std::int64_t read_whole(const Node& node, const Range& range, const Doc& doc, std::int64_t low, std::int64_t high) {
    std::int64_t value = 0;
    if (const auto* whole = std::get_if<std::int64_t>(&node.value)) {
        value = *whole;
    } else if (const auto* number = std::get_if<double>(&node.value)) {
        // 1e5 is a usual way to write a count.
        if (!std::isfinite(*number)) refuse(node, fmt::format("is not a finite number ({})", doc.text));
        if (*number != std::trunc(*number)) refuse(node, fmt::format("is no whole number ({})", doc.text));
        check_range(node, *number, range, doc);
        if (std::abs(*number) >= 0x1p63) refuse(node, fmt::format("is too large; at most {} ({})", high, doc.text));
        value = static_cast<std::int64_t>(*number);
    } else {
        refuse_type(node, "a whole number", doc);
    }
    check_range(node, static_cast<double>(value), range, doc);
    if (value < low || value > high)
        refuse(node, fmt::format("is too {}; at {} {} ({})", value < low ? "small" : "large",
                                 value < low ? "least" : "most", value < low ? low : high, doc.text));
    return value;
}

const Node::Array& array_of_three(const Node& node, std::string_view what, const Doc& doc) {
    const Node::Array* items = node.array();
    if (items == nullptr) refuse_type(node, fmt::format("an array of 3 {}", what), doc);
    if (items->size() != 3)
        refuse(node, fmt::format("has {} entries; 3 {} are expected ({})", items->size(), what, doc.text));
    return *items;
}

bool read_bool(const Node& node, const Doc& doc) {
    const bool* value = std::get_if<bool>(&node.value);
    if (value == nullptr) refuse_type(node, "true or false", doc);
    return *value;
}

std::string last_part(const std::string& dotted) { return dotted.substr(dotted.rfind('.') + 1); }

}  // namespace

std::string range_text(const Range& range) {
    const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
    if (low && high)
        return fmt::format("{}{}, {}{}", range.low_open ? "(" : "[", range.low, range.high,
                           range.high_open ? ")" : "]");
    if (low) return fmt::format("{} {}", range.low_open ? ">" : ">=", range.low);
    if (high) return fmt::format("{} {}", range.high_open ? "<" : "<=", range.high);
    return {};
}

std::string words_text(std::span<const std::string> words) { return fmt::format("{}", fmt::join(words, " | ")); }

OptionReader::OptionReader(const Node& table, ModelUnits units) : table_(table), units_(std::move(units)) {
    const bool nothing = std::holds_alternative<std::monostate>(table.value);
    if (table.table() == nullptr && !nothing)
        refuse(table, fmt::format("is {}; a table is expected", type_name(table)));
}

void OptionReader::operator()(std::string_view name, bool& value, const Doc& doc) {
    if (const Node* node = take(name)) value = read_bool(*node, doc);
}

void OptionReader::operator()(std::string_view name, std::string& value, const Doc& doc) {
    const Node* node = take(name);
    if (node == nullptr) return;
    const auto* text = std::get_if<std::string>(&node->value);
    if (text == nullptr) refuse_type(*node, "a string", doc);
    value = *text;
}

void OptionReader::operator()(std::string_view name, std::array<bool, 3>& value, const Doc& doc) {
    const Node* node = take(name);
    if (node == nullptr) return;
    const Node::Array& items = array_of_three(*node, "booleans", doc);
    for (std::size_t k = 0; k < 3; ++k) value[k] = read_bool(items[k], doc);
}

void OptionReader::operator()(std::string_view name, int& value, const Range& range, const Doc& doc) {
    using Limits = std::numeric_limits<int>;
    if (const Node* node = take(name))
        value = static_cast<int>(read_whole(*node, range, doc, Limits::min(), Limits::max()));
}

void OptionReader::operator()(std::string_view name, std::int64_t& value, const Range& range, const Doc& doc) {
    using Limits = std::numeric_limits<std::int64_t>;
    if (const Node* node = take(name)) value = read_whole(*node, range, doc, Limits::min(), Limits::max());
}

void OptionReader::operator()(std::string_view name, double& value, const Range& range, const Doc& doc) {
    const Node* node = take(name);
    if (node == nullptr) return;
    value = read_number(*node, doc, unit_of(doc, units_));
    check_range(*node, value, range, doc);
}

void OptionReader::operator()(std::string_view name, Vec3& value, const Range& range, const Doc& doc) {
    const Node* node = take(name);
    if (node == nullptr) return;
    const Node::Array& items = array_of_three(*node, "numbers", doc);
    for (std::size_t k = 0; k < 3; ++k) {
        value[k] = read_number(items[k], doc, unit_of(doc, units_));
        check_range(items[k], value[k], range, doc);
    }
}

const Node* OptionReader::take(std::string_view name) {
    names_.emplace_back(name);
    return table_.find(name);
}

const Node& OptionReader::group_table(const Node& node, std::string_view text) const {
    if (node.table() == nullptr)
        refuse(node, fmt::format("is {}; a table [{}] is expected ({})", type_name(node), node.path, text));
    return node;
}

std::size_t OptionReader::word_index(const Node& node, const std::vector<std::string>& words, const Doc& doc) const {
    const auto* word = std::get_if<std::string>(&node.value);
    if (word == nullptr) refuse_type(node, fmt::format("one of {}", words_text(words)), doc);
    const auto it = std::find(words.begin(), words.end(), *word);
    if (it != words.end()) return static_cast<std::size_t>(it - words.begin());
    const auto near = nearest_word(*word, words);
    refuse(node, fmt::format("is not one of {}{}", words_text(words),
                             near ? fmt::format("; did you mean \"{}\"?", *near) : fmt::format(" ({})", doc.text)));
}

void OptionReader::collect_unknown() {
    const Node::Table* entries = table_.table();
    if (entries == nullptr) return;
    for (const auto& [key, node] : *entries)
        if (std::find(names_.begin(), names_.end(), key) == names_.end())
            unknown_.push_back({&node, key, table_.path, names_});
}

void OptionReader::finish(std::span<const OptionInfo> all) {
    collect_unknown();
    if (unknown_.empty()) return;
    const auto first = std::min_element(unknown_.begin(), unknown_.end(), [](const auto& a, const auto& b) {
        return a.node->where.line < b.node->where.line;
    });
    // A right name at the wrong place helps more than a similar one at the right place.
    const auto at = [](const std::string& table, const std::string& name) {
        return table.empty() ? name : table + "." + name;
    };
    std::optional<std::string> meant;
    for (const OptionInfo& info : all)
        if (!meant && last_part(info.name) == first->key) meant = at(table_.path, info.name);
    if (const auto near = nearest_word(first->key, first->known); !meant && near) meant = at(first->table, *near);
    const std::string help =
        meant ? fmt::format("did you mean {}?", *meant) : fmt::format("known are {}", fmt::join(first->known, ", "));
    throw InputError(first->node->where, fmt::format("{} is not an option; {}", first->node->path, help));
}

void OptionDescriber::add(
    std::string_view name, std::string type, std::string default_text, std::string allowed, const Doc& doc) {
    infos_.push_back({prefix_ + std::string(name), std::move(type), std::move(default_text), std::move(allowed), doc});
}

void OptionDescriber::operator()(std::string_view name, bool& value, const Doc& doc) {
    add(name, "boolean", value ? "true" : "false", "", doc);
}

void OptionDescriber::operator()(std::string_view name, std::string& value, const Doc& doc) {
    add(name, "text", quoted_text(value), "", doc);
}

void OptionDescriber::operator()(std::string_view name, std::array<bool, 3>& value, const Doc& doc) {
    add(name, "3 booleans", fmt::format("[{}]", fmt::join(value, ", ")), "", doc);
}

void OptionDescriber::operator()(std::string_view name, int& value, const Range& range, const Doc& doc) {
    add(name, "integer", fmt::format("{}", value), range_text(range), doc);
}

void OptionDescriber::operator()(std::string_view name, std::int64_t& value, const Range& range, const Doc& doc) {
    add(name, "integer", fmt::format("{}", value), range_text(range), doc);
}

void OptionDescriber::operator()(std::string_view name, double& value, const Range& range, const Doc& doc) {
    add(name, "number", fmt::format("{}", value), range_text(range), doc);
}

void OptionDescriber::operator()(std::string_view name, Vec3& value, const Range& range, const Doc& doc) {
    add(name, "3 numbers", fmt::format("[{}]", fmt::join(value.v, ", ")), range_text(range), doc);
}

void OptionResolver::operator()(std::string_view name, std::array<bool, 3>& value, const Doc&) {
    Node::Array items(3);
    for (std::size_t k = 0; k < 3; ++k) items[k].value = value[k];
    add(name).value = std::move(items);
}

void OptionResolver::operator()(std::string_view name, int& value, const Range&, const Doc&) {
    add(name).value = std::int64_t{value};
}

void OptionResolver::operator()(std::string_view name, Vec3& value, const Range&, const Doc&) {
    Node::Array items(3);
    for (std::size_t k = 0; k < 3; ++k) items[k].value = value[k];
    add(name).value = std::move(items);
}

Node& OptionResolver::add(std::string_view name) {
    Node entry;
    entry.path = join_path(table_.path, name);
    return table_.set(name, std::move(entry));
}

}  // namespace lamella::sim
