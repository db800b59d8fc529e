#include "lamella/sim/node.h"

#include <algorithm>

#include <fmt/format.h>

namespace lamella::sim {

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
        std::string operator()(const std::string& s) const { return fmt::format("\"{}\"", s); }
        std::string operator()(const Node::Array& a) const {
            std::string text = "[";
            for (std::size_t i = 0; i < a.size() && text.size() < kLongest; ++i)
                text += (i > 0 ? ", " : "") + found_text(a[i]);
            return text + "]";
        }
        std::string operator()(const Node::Table&) const { return "{...}"; }
    };
    std::string text = std::visit(Text{}, node.value);
    if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
    return text;
}

}  // namespace lamella::sim
