#include "lamella/scene/detail/toml_writer.h"

#include <fmt/format.h>

#include <algorithm>

namespace lamella::scene::detail {
namespace {

struct ValueText {
    std::string operator()(std::monostate) const { return "\"\""; }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
    std::string operator()(double d) const { return sim::exact_text(d); }
    std::string operator()(const std::string& s) const { return sim::quoted_text(s); }
    std::string operator()(const sim::Node::Array& items) const {
        std::string text = "[";
        for (std::size_t i = 0; i < items.size(); ++i)
            text += fmt::format("{}{}", i > 0 ? ", " : "", toml_value_text(items[i]));
        return text + "]";
    }
    std::string operator()(const sim::Node::Table& entries) const {
        std::string text = "{";
        for (std::size_t i = 0; i < entries.size(); ++i)
            text += fmt::format("{} {} = {}", i > 0 ? "," : "", sim::key_text(entries[i].first),
                                toml_value_text(entries[i].second));
        return text + " }";
    }
};

std::string commented(std::string line, const std::string& comment) {
    if (comment.empty()) return line + "\n";
    constexpr std::size_t kColumn = 40;
    line.resize(std::max(line.size() + 2, kColumn), ' ');
    return line + "# " + comment + "\n";
}

void write_table(std::string& out,
                 const std::string& heading,
                 const std::string& prefix,
                 const sim::Node::Table& entries,
                 const CommentOf& comment_of) {
    for (const auto& [key, value] : entries)
        if (value.table() == nullptr)
            out +=
                commented(fmt::format("{} = {}", sim::key_text(key), toml_value_text(value)), comment_of(prefix + key));
    for (const auto& [key, value] : entries) {
        if (value.table() == nullptr) continue;
        const std::string inner = heading.empty() ? sim::key_text(key) : heading + "." + sim::key_text(key);
        out += '\n';
        out += commented(fmt::format("[{}]", inner), comment_of(prefix + key));
        write_table(out, inner, prefix + key + ".", *value.table(), comment_of);
    }
}

}  // namespace

std::string toml_value_text(const sim::Node& value) { return std::visit(ValueText{}, value.value); }

std::string toml_text(std::string_view name, const sim::Node& table, const CommentOf& comment_of) {
    std::string out;
    const std::string heading = name.empty() ? "" : sim::key_text(name);
    if (!heading.empty()) out += commented(fmt::format("[{}]", heading), comment_of(""));
    if (table.table() != nullptr) write_table(out, heading, "", *table.table(), comment_of);
    return out;
}

}  // namespace lamella::scene::detail
