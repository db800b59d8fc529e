#include "lamella/sim/node.h"

#include <fmt/format.h>

#include <algorithm>

namespace lamella::sim {
namespace {

/// The beginning of a long text, cut between two characters.
std::string shortened(std::string_view text, std::size_t longest) {
    if (text.size() <= longest) return std::string(text);
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // inside a UTF-8 character
    return std::string(text.substr(0, end)) + "...";
}

}  // namespace

const Node* Node::find(std::string_view key) const {
    const Table* entries = table();
    if (entries == nullptr) return nullptr;
    const auto it = std::find_if(entries->begin(), entries->end(), [&](const auto& e) { return e.first == key; });
    return it == entries->end() ? nullptr : &it->second;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

Node& Node::set(std::string_view key, Node entry) {
    if (Node* present = find(key)) return *present = std::move(entry);
    if (table() == nullptr) value = Table{};
    return std::get<Table>(value).emplace_back(key, std::move(entry)).second;
}

std::string type_name(const Node& node) {
    static constexpr const char* kNames[] = {"nothing",  "a boolean", "an integer", "a number",
                                             "a string", "an array",  "a table"};
    return kNames[node.value.index()];
}

std::string found_text(const Node& node) {
    constexpr std::size_t kLongest = 60;
    struct Text {
        std::string operator()(std::monostate) const { return "nothing"; }
        std::string operator()(bool b) const { return b ? "true" : "false"; }
        std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
        std::string operator()(double d) const { return fmt::format("{}", d); }
        std::string operator()(const std::string& s) const { return quoted_text(shortened(s, kLongest)); }
        std::string operator()(const Node::Array& a) const {
            std::string text = "[";
            for (std::size_t i = 0; i < a.size(); ++i) {
                if (text.size() > kLongest) return text + ", ...]";
                text += (i > 0 ? ", " : "") + found_text(a[i]);
            }
            return text + "]";
        }
        std::string operator()(const Node::Table&) const { return "{...}"; }
    };
    return std::visit(Text{}, node.value);
}

std::string quoted_text(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            quoted += fmt::format("\\{}", c);
        else if (c == '\n')
            quoted += "\\n";
        else if (c == '\t')
            quoted += "\\t";
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            quoted += fmt::format("\\u{:04x}", int{c});
        else
            quoted += c;
    }
    return quoted + "\"";
}

std::string exact_text(double value) {
    std::string text = fmt::format("{}", value);
    const bool whole = text.find_first_not_of("-0123456789") == std::string::npos;
    return whole ? text + ".0" : text;
}

std::string key_text(std::string_view key) {
    const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
    });
    return bare ? std::string(key) : quoted_text(key);
}

std::string join_path(std::string_view parent, std::string_view key) {
    constexpr std::size_t kLongest = 60;
    const std::string shown = key_text(shortened(key, kLongest));
    return parent.empty() ? shown : fmt::format("{}.{}", parent, shown);
}

}  // namespace lamella::sim
