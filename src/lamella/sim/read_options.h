#pragma once

// From the description of a solver's options (options.h) to a checked options struct, and back to text.

#include "lamella/core/vec.h"
#include "lamella/sim/node.h"
#include "lamella/sim/options.h"
#include "lamella/sim/registry.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::sim {

/// What the words "length", "mass" and "time" in a Doc's unit stand for: a unit ("s"), or "" where the quantity is
/// dimensionless, as in the bubble solver.
struct ModelUnits {
    std::string length = {};
    std::string mass = {};
    std::string time = {};
};

/// "[0, 1]", "(0, 2)", ">= 0", "> 0"; "" when every number is allowed.
std::string range_text(const Range& range);

/// "background | pairwise".
std::string words_text(std::span<const std::string> words);

template <class Enum>
std::vector<std::string> words_of(const Choices<Enum>& choices) {
    std::vector<std::string> words;
    for (const auto& choice : choices) words.push_back(choice.first);
    return words;
}

/// The visitor that takes options from a table of a scene. Used through read_options.
class OptionReader {
public:
    OptionReader(const Node& table, ModelUnits units);

    void operator()(std::string_view name, bool& value, const Doc& doc);
    void operator()(std::string_view name, std::string& value, const Doc& doc);
    void operator()(std::string_view name, std::array<bool, 3>& value, const Doc& doc);
    void operator()(std::string_view name, int& value, const Range& range, const Doc& doc);
    void operator()(std::string_view name, std::int64_t& value, const Range& range, const Doc& doc);
    void operator()(std::string_view name, double& value, const Range& range, const Doc& doc);
    void operator()(std::string_view name, Vec3& value, const Range& range, const Doc& doc);

    template <class Enum>
    void operator()(std::string_view name, Enum& value, const Choices<Enum>& choices, const Doc& doc) {
        if (const Node* node = take(name)) value = choices[word_index(*node, words_of(choices), doc)].second;
    }

    template <class Group>
    void group(std::string_view name, Group& value, std::string_view text) {
        const Node* node = take(name);
        if (node == nullptr) return;
        OptionReader inner(group_table(*node, text), units_);
        value.visit(inner);
        inner.collect_unknown();
        unknown_.insert(unknown_.end(), inner.unknown_.begin(), inner.unknown_.end());
    }

    /// Refuses the first key that is no option. @param all  every option of the struct, for suggestions
    /// @throws InputError
    void finish(std::span<const OptionInfo> all);

private:
    struct UnknownKey {
        const Node* node;
        std::string key;
        std::string table;               ///< path of the table that it stands in
        std::vector<std::string> known;  ///< the names at its place
    };

    const Node* take(std::string_view name);
    const Node& group_table(const Node& node, std::string_view text) const;
    std::size_t word_index(const Node& node, const std::vector<std::string>& words, const Doc& doc) const;
    void collect_unknown();

    const Node& table_;
    ModelUnits units_;
    std::vector<std::string> names_;
    std::vector<UnknownKey> unknown_;
};

/// The visitor that lists options. Used through describe_options.
class OptionDescriber {
public:
    void operator()(std::string_view name, bool& value, const Doc& doc);
    void operator()(std::string_view name, std::string& value, const Doc& doc);
    void operator()(std::string_view name, std::array<bool, 3>& value, const Doc& doc);
    void operator()(std::string_view name, int& value, const Range& range, const Doc& doc);
    void operator()(std::string_view name, std::int64_t& value, const Range& range, const Doc& doc);
    void operator()(std::string_view name, double& value, const Range& range, const Doc& doc);
    void operator()(std::string_view name, Vec3& value, const Range& range, const Doc& doc);

    template <class Enum>
    void operator()(std::string_view name, Enum& value, const Choices<Enum>& choices, const Doc& doc) {
        const auto now = std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.second == value; });
        LAMELLA_ASSERT(now != choices.end());
        add(name, "word", quoted_text(now->first), words_text(words_of(choices)), doc);
    }

    template <class Group>
    void group(std::string_view name, Group& value, std::string_view text) {
        add(name, "group", "", "", {std::string(text)});
        const std::string outside = prefix_;
        prefix_ = outside + std::string(name) + ".";
        value.visit(*this);
        prefix_ = outside;
    }

    std::vector<OptionInfo> take() { return std::move(infos_); }

private:
    void add(std::string_view name, std::string type, std::string default_text, std::string allowed, const Doc& doc);

    std::string prefix_;
    std::vector<OptionInfo> infos_;
};

/// The visitor that turns options back into a table. Used through resolve_options.
class OptionResolver {
public:
    explicit OptionResolver(Node& table) : table_(table) { table_.value = Node::Table{}; }

    void operator()(std::string_view name, bool& value, const Doc&) { add(name).value = value; }
    void operator()(std::string_view name, std::string& value, const Doc&) { add(name).value = value; }
    void operator()(std::string_view name, std::array<bool, 3>& value, const Doc&);
    void operator()(std::string_view name, int& value, const Range&, const Doc&);
    void operator()(std::string_view name, std::int64_t& value, const Range&, const Doc&) { add(name).value = value; }
    void operator()(std::string_view name, double& value, const Range&, const Doc&) { add(name).value = value; }
    void operator()(std::string_view name, Vec3& value, const Range&, const Doc&);

    template <class Enum>
    void operator()(std::string_view name, Enum& value, const Choices<Enum>& choices, const Doc&) {
        const auto now = std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.second == value; });
        LAMELLA_ASSERT(now != choices.end());
        add(name).value = now->first;
    }

    template <class Group>
    void group(std::string_view name, Group& value, std::string_view) {
        OptionResolver inner(add(name));
        value.visit(inner);
    }

private:
    Node& add(std::string_view name);

    Node& table_;
};

/// Every option of a struct with its default, in the order of its visit(); a group comes as an entry of type "group"
/// before its members.
template <class Options>
std::vector<OptionInfo> describe_options() {
    Options defaults;
    OptionDescriber describer;
    defaults.visit(describer);
    return describer.take();
}

/// The options that `table` gives, defaults for the rest.
/// @param table  a table of a scene; an empty Node gives the defaults
/// @throws InputError  unknown key (with the nearest known one), wrong type, out of range, not finite, unit of another
///                     dimension, unknown word; the message names file:line, the key, what was found and what is
///                     allowed
template <class Options>
Options read_options(const Node& table, const ModelUnits& units = {}) {
    Options options;
    OptionReader reader(table, units);
    options.visit(reader);
    reader.finish(describe_options<Options>());
    return options;
}

/// Every value of `options`, defaults included, as a table that read_options turns into equal options.
/// @param path  of the table in its scene ("bubble"), for later messages
template <class Options>
Node resolve_options(Options options, std::string path = {}) {
    Node table;
    table.path = std::move(path);
    OptionResolver resolver(table);
    options.visit(resolver);
    return table;
}

}  // namespace lamella::sim
