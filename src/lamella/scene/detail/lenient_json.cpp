#include "lamella/scene/detail/lenient_json.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

namespace lamella::scene::detail {
namespace {

constexpr int kDeepest = 32;

void append_utf8(std::string& out, std::uint32_t code) {
    const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(static_cast<unsigned char>(byte)); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xc0 | code >> 6);
        put(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
        put(0xe0 | code >> 12);
        put(0x80 | (code >> 6 & 0x3f));
        put(0x80 | (code & 0x3f));
    } else {
        put(0xf0 | code >> 18);
        put(0x80 | (code >> 12 & 0x3f));
        put(0x80 | (code >> 6 & 0x3f));
        put(0x80 | (code & 0x3f));
    }
}

class Parser {
public:
    Parser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    sim::Node parse() {
        if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;  // byte order mark
        skip_spaces();
        if (peek() != '{') refuse("an object {...} is expected");
        sim::Node root = value("", 0);
        skip_spaces();
        if (at_ < text_.size()) refuse("there is something after the closing }");
        return root;
    }

private:
    sim::Node value(std::string path, int depth) {
        skip_spaces();
        if (depth > kDeepest) refuse(fmt::format("values are nested deeper than {} levels", kDeepest));
        sim::Node node{std::monostate{}, {name_, line_, 0}, std::move(path)};
        const char c = peek();
        if (c == '{')
            node.value = object(node.path, depth);
        else if (c == '[')
            node.value = array(node.path, depth);
        else if (c == '"')
            node.value = string();
        else if (take_word("true"))
            node.value = true;
        else if (take_word("false"))
            node.value = false;
        else if (take_word("null"))
            node.value = std::monostate{};
        else
            number(node);
        return node;
    }

    sim::Node::Table object(const std::string& path, int depth) {
        sim::Node::Table entries;
        std::set<std::string> keys;
        ++at_;
        for (bool first = true; !ends_with('}', first); first = false) {
            if (peek() != '"') refuse("a key in double quotes is expected");
            std::string key = string();
            if (!keys.insert(key).second) refuse(fmt::format("{} is given twice", sim::join_path(path, key)));
            skip_spaces();
            if (peek() != ':') refuse(fmt::format("a ':' is expected after {}", sim::join_path(path, key)));
            ++at_;
            sim::Node entry = value(sim::join_path(path, key), depth + 1);
            entries.emplace_back(std::move(key), std::move(entry));
        }
        return entries;
    }

    sim::Node::Array array(const std::string& path, int depth) {
        sim::Node::Array items;
        ++at_;
        for (bool first = true; !ends_with(']', first); first = false)
            items.push_back(value(fmt::format("{}[{}]", path, items.size()), depth + 1));
        return items;
    }

    /// Between two members: skips a comma, or does without one; true when the closing bracket was taken.
    bool ends_with(char bracket, bool first) {
        skip_spaces();
        const bool comma = !first && peek() == ',';
        if (comma) {
            ++at_;
            skip_spaces();
        }
        if (at_ == text_.size()) refuse(fmt::format("the file ends before a closing {}", bracket));
        if (peek() != bracket) return false;
        if (comma) refuse(fmt::format("there is a comma before the closing {}", bracket));
        ++at_;
        return true;
    }

    std::string string() {
        std::string out;
        const int begin = line_;
        for (++at_; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '"') {
                ++at_;
                return out;
            }
            if (c == '\\')
                escape(out);
            else if (c == '\n')
                ++line_, out += ' ';
            else if (c == '\r')
                continue;
            else if (static_cast<unsigned char>(c) < 0x20 && c != '\t')
                refuse("there is a control character in a string");
            else
                out += c;
        }
        line_ = begin;
        refuse("a string begins here and does not end");
    }

    /// At the backslash; leaves at the last letter of the escape.
    void escape(std::string& out) {
        static constexpr std::string_view kLetters = "\"\\/bfnrt", kMeanings = "\"\\/\b\f\n\r\t";
        ++at_;
        const std::size_t letter = kLetters.find(peek());
        if (at_ < text_.size() && letter != std::string_view::npos) {
            out += kMeanings[letter];
            return;
        }
        if (peek() != 'u') refuse("there is an unknown escape in a string");
        std::uint32_t code = hex4();
        if (code >= 0xd800 && code < 0xdc00 && text_.substr(at_ + 1).starts_with("\\u")) {
            at_ += 2;
            const std::uint32_t low = hex4();
            if (low < 0xdc00 || low > 0xdfff) refuse("there is half a surrogate pair in a string");
            code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
        }
        if (code >= 0xd800 && code <= 0xdfff) refuse("there is half a surrogate pair in a string");
        append_utf8(out, code);
    }

    /// At the 'u'; leaves at the last digit.
    std::uint32_t hex4() {
        std::uint32_t code = 0;
        const std::string_view digits = text_.substr(at_ + 1, 4);
        const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
        if (digits.size() != 4 || failed != std::errc{} || end != digits.data() + 4)
            refuse("\\u must be followed by four hexadecimal digits");
        at_ += 4;
        return code;
    }

    void number(sim::Node& node) {
        const std::size_t begin = at_;
        while (at_ < text_.size() && std::string_view("+-.0123456789eE").find(text_[at_]) != std::string_view::npos)
            ++at_;
        const std::string_view digits = text_.substr(begin, at_ - begin);
        const char* const end = digits.data() + digits.size();
        if (digits.empty()) refuse("a value is expected");
        std::int64_t whole = 0;
        if (const auto read = std::from_chars(digits.data(), end, whole); read.ec == std::errc{} && read.ptr == end) {
            node.value = whole;
            return;
        }
        double real = 0.0;
        const auto read = std::from_chars(digits.data(), end, real);
        if (read.ec != std::errc{} || read.ptr != end || !std::isfinite(real))
            refuse(fmt::format("{} is no number that fits", sim::quoted_text(digits.substr(0, 40))));
        node.value = real;
    }

    bool take_word(std::string_view word) {
        if (!text_.substr(at_).starts_with(word)) return false;
        at_ += word.size();
        return true;
    }

    void skip_spaces() {
        for (; at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos; ++at_)
            if (text_[at_] == '\n') ++line_;
    }

    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    [[noreturn]] void refuse(const std::string& what) const { throw InputError({name_, line_, 0}, what); }

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0;
    int line_ = 1;
};

}  // namespace

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
        const unsigned lead = byte(i);
        const std::size_t length = lead < 0x80   ? 1
                                   : lead < 0xc2 ? 0
                                   : lead < 0xe0 ? 2
                                   : lead < 0xf0 ? 3
                                   : lead < 0xf5 ? 4
                                                 : 0;
        if (length == 0 || i + length > text.size()) return false;
        for (std::size_t k = 1; k < length; ++k)
            if ((byte(i + k) & 0xc0) != 0x80) return false;
        // The second byte rules out overlong forms, surrogates, and what lies beyond U+10FFFF.
        if (lead == 0xe0 && byte(i + 1) < 0xa0) return false;
        if (lead == 0xed && byte(i + 1) > 0x9f) return false;
        if (lead == 0xf0 && byte(i + 1) < 0x90) return false;
        if (lead == 0xf4 && byte(i + 1) > 0x8f) return false;
        i += length;
    }
    return true;
}

sim::Node read_lenient_json(std::string_view text, const std::string& name) {
    if (!is_utf8(text)) throw InputError({name, 0, 0}, "is not UTF-8 text");
    return Parser(text, name).parse();
}

}  // namespace lamella::scene::detail
