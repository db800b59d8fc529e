#include "lamella/scene/detail/toml_reader.h"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lamella/core/error.h"

// toml++ asserts things that malformed text breaks ("[" at the end of a line), and in release builds, that of its shared
// library included, it hands these to the optimizer as promises. Compiled here, without them, its checks decide alone.
#undef TOML_HEADER_ONLY
#undef TOML_SHARED_LIB
#undef NDEBUG
#define TOML_HEADER_ONLY 1
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

namespace lamella::scene::detail {
namespace {

// Both the parser and the destructors of its tables recurse; no scene needs more than three or four levels.
constexpr int kDeepest = 32;

/// Refuses text that would nest too deeply, before anything recursive sees it. A dotted key opens a level per dot, a
/// bracket one more. Strings and comments are skipped; broken ones end at the line's end, where the parser will say so.
class DepthCheck {
public:
    DepthCheck(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    void run() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"' || c == '\'') skip_string(c);
            else if (c == '#') skip_to_line_end();
            else count(c);
        }
    }

private:
    void count(char c) {
        ++at_;
        if (c == '.') ++dots_;
        else if (c == '[' || c == '{') ++brackets_, dots_ = 0;
        else if (c == ']' || c == '}') --brackets_, dots_ = 0;
        else if (c == '=' || c == ',') dots_ = 0;
        else if (c == '\n') ++line_, dots_ = 0;
        if (dots_ <= kDeepest && brackets_ <= kDeepest) return;
        throw InputError({name_, line_, 0}, fmt::format("tables or arrays are nested deeper than {} levels", kDeepest));
    }

    void skip_string(char quote) {
        const std::string three(3, quote);
        const bool long_form = text_.substr(at_).starts_with(three);
        at_ += long_form ? 3 : 1;
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '\n' && !long_form) return;
            if (c == '\n') ++line_;
            if (c == '\\' && quote == '"' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n') {
                at_ += 2;
            } else if (!long_form && c == quote) {
                ++at_;
                return;
            } else if (long_form && text_.substr(at_).starts_with(three)) {
                at_ += 3;
                for (int k = 0; k < 2 && at_ < text_.size() && text_[at_] == quote; ++k) ++at_;  // """a"""""
                return;
            } else {
                ++at_;
            }
        }
    }

    void skip_to_line_end() {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    }

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0;
    int line_ = 1;
    int dots_ = 0;
    int brackets_ = 0;
};

/// Builds Nodes from the parser's tree.
class Converter {
public:
    explicit Converter(const std::string& name) : name_(name) {}

    sim::Node table(const toml::table& source, SourceLocation where, std::string path) const {
        sim::Node node{sim::Node::Table{}, std::move(where), std::move(path)};
        // The parser sorts keys by name; errors should come in the order of the file.
        std::vector<std::tuple<toml::source_position, const toml::key*, const toml::node*>> entries;
        for (const auto& [key, value] : source) entries.emplace_back(key.source().begin, &key, &value);
        std::stable_sort(entries.begin(), entries.end(),
                         [](const auto& a, const auto& b) { return std::get<0>(a) < std::get<0>(b); });
        auto& out = std::get<sim::Node::Table>(node.value);
        out.reserve(entries.size());
        for (const auto& [position, key, value] : entries)
            out.emplace_back(std::string(key->str()),
                             convert(*value, location(position), sim::join_path(node.path, key->str())));
        return node;
    }

private:
    SourceLocation location(const toml::source_position& position) const {
        return {name_, static_cast<int>(position.line), static_cast<int>(position.column)};
    }

    sim::Node convert(const toml::node& source, SourceLocation where, std::string path) const {
        if (const auto* nested = source.as_table()) return table(*nested, std::move(where), std::move(path));
        if (const auto* items = source.as_array()) return array(*items, std::move(where), std::move(path));
        sim::Node node{std::monostate{}, std::move(where), std::move(path)};
        if (const auto* text = source.as_string()) node.value = text->get();
        else if (const auto* whole = source.as_integer()) node.value = whole->get();
        else if (const auto* number = source.as_floating_point()) node.value = number->get();
        else if (const auto* flag = source.as_boolean()) node.value = flag->get();
        else
            throw InputError(node.where, fmt::format("{} is a date or time of day; a scene has none: write a number or"
                                                     " a quoted string",
                                                     node.path));
        return node;
    }

    sim::Node array(const toml::array& source, SourceLocation where, std::string path) const {
        sim::Node::Array items;
        items.reserve(source.size());
        for (std::size_t i = 0; i < source.size(); ++i)
            items.push_back(convert(source[i], location(source[i].source().begin), fmt::format("{}[{}]", path, i)));
        return {std::move(items), std::move(where), std::move(path)};
    }

    const std::string& name_;
};

/// The parser's messages, on one line.
std::string one_line(std::string_view text) {
    std::string line;
    for (const char c : text) line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    return line;
}

InputError explained(const toml::parse_error& problem, const std::string& name) {
    std::string_view text = problem.description();
    constexpr std::string_view kBefore = "Error while parsing ";  // the reader knows that something is wrong
    if (text.starts_with(kBefore)) text.remove_prefix(kBefore.size());
    std::string help;
    if (text.find("redefine") != std::string_view::npos) help = " (each key and table may be given once)";
    else if (text.find("utf-8") != std::string_view::npos || text.find("UTF-8") != std::string_view::npos)
        help = " (a scene is UTF-8 text)";
    const auto& position = problem.source().begin;
    return InputError({name, static_cast<int>(position.line), static_cast<int>(position.column)}, one_line(text) + help);
}

sim::Node parse(std::string_view text, const std::string& name) {
    if (text.size() > kLargestScene)
        throw InputError({name, 0, 0}, fmt::format("is larger than {} MiB; that is no scene", kLargestScene >> 20));
    DepthCheck(text, name).run();
    try {
        return Converter(name).table(toml::parse(text, name), {name, 1, 1}, "");
    } catch (const toml::parse_error& problem) {
        throw explained(problem, name);
    }
}

}  // namespace

sim::Node read_toml(std::string_view text, const std::string& name) { return parse(text, name); }

std::optional<sim::Node> read_toml_value(std::string_view text) {
    try {
        sim::Node file = parse(fmt::format("value = {}", text), "");
        auto& entries = std::get<sim::Node::Table>(file.value);
        // "1\nother = 2" is a value and something else.
        if (entries.size() != 1 || entries.front().first != "value") return std::nullopt;
        return std::move(entries.front().second);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace lamella::scene::detail
