#include "lamella/io/detail/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace lamella::io::detail {
namespace {

constexpr std::string_view kSpace = " \t\r\n";
constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
    {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};

/// Length of the UTF-8 character that `text` starts with, or 0 when it is none or a control character.
std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(text[k])); };
    if (byte(0) < 0x80) return byte(0) >= 0x20 && byte(0) != 0x7F ? 1 : 0;
    const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
    if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < length) return 0;
    unsigned code = byte(0) & (0x7FU >> length);
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte(k) & 0xC0U) != 0x80U) return 0;
        code = code << 6 | (byte(k) & 0x3FU);
    }
    constexpr std::array<unsigned, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
    const bool valid = code >= kSmallest[length] && code < 0x110000 && (code < 0xD800 || code > 0xDFFF) &&
                       code != 0xFFFE && code != 0xFFFF;
    return valid ? length : 0;
}

bool is_word_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.' || c == ':';
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kSpace);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

}  // namespace

bool is_printable(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

std::string xml_escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const auto* const entity =
            std::find_if(kEntities.begin(), kEntities.end(), [&](const auto& e) { return e.second == c; });
        if (entity != kEntities.end()) {
            out += entity->first;
        } else {
            out += c;
        }
    }
    return out;
}

InputError XmlScanner::error(const std::string& message) const {
    const std::string_view before = text_.substr(0, token_);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    return InputError({name_, static_cast<int>(line), 0}, message);
}

XmlToken XmlScanner::next() {
    while (position_ < text_.size()) {
        token_ = position_;
        if (take("<?")) {
            skip_past("?>");
        } else if (take("<!--")) {
            skip_past("-->");
        } else if (take("<")) {
            return tag();
        } else {
            const std::size_t end = std::min(text_.find('<', position_), text_.size());
            const std::string_view text = trimmed(text_.substr(position_, end - position_));
            position_ = end;
            if (!text.empty()) return {.kind = XmlToken::Kind::kText, .text = unescaped(text)};
        }
    }
    token_ = position_;
    return {};
}

XmlToken XmlScanner::tag() {
    XmlToken token{.kind = take("/") ? XmlToken::Kind::kEnd : XmlToken::Kind::kStart};
    token.name = word();
    skip_space();
    while (token.kind == XmlToken::Kind::kStart && position_ < text_.size() && is_word_character(text_[position_])) {
        const std::string key(word());
        skip_space();
        if (!take("=")) throw error(fmt::format("<{}>: \"=\" was expected after {}", token.name, key));
        skip_space();
        const std::string_view quote = position_ < text_.size() ? text_.substr(position_, 1) : "";
        if (quote != "\"" && quote != "'") throw error(fmt::format("<{}>: {} has no quoted value", token.name, key));
        const std::size_t end = text_.find(quote, ++position_);
        if (end == std::string_view::npos)
            throw error(fmt::format("<{}>: the value of {} does not end", token.name, key));
        token.attributes[key] = unescaped(text_.substr(position_, end - position_));
        position_ = end + 1;
        skip_space();
    }
    if (token.kind == XmlToken::Kind::kStart) token.empty_element = take("/");
    if (!take(">")) throw error(fmt::format("the tag <{}> is not well-formed XML", token.name));
    return token;
}

std::string_view XmlScanner::word() {
    const std::size_t begin = position_;
    while (position_ < text_.size() && is_word_character(text_[position_])) ++position_;
    if (position_ == begin) throw error("this is not well-formed XML: a name was expected");
    return text_.substr(begin, position_ - begin);
}

std::string XmlScanner::unescaped(std::string_view text) const {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '&') {
            out += text[i];
            continue;
        }
        const std::string_view entity = text.substr(i, text.substr(i, 10).find(';') + 1);
        const auto* const known =
            std::find_if(kEntities.begin(), kEntities.end(), [&](const auto& e) { return e.first == entity; });
        if (known == kEntities.end()) throw error("only the XML entities amp, lt, gt, quot and apos are known");
        out += known->second;
        i += entity.size() - 1;
    }
    return out;
}

void XmlScanner::skip_space() { position_ = std::min(text_.find_first_not_of(kSpace, position_), text_.size()); }

bool XmlScanner::take(std::string_view expected) {
    if (!text_.substr(position_).starts_with(expected)) return false;
    position_ += expected.size();
    return true;
}

void XmlScanner::skip_past(std::string_view end) {
    const std::size_t found = text_.find(end, position_);
    if (found == std::string_view::npos)
        throw error(fmt::format("this is not well-formed XML: \"{}\" is missing", end));
    position_ = found + end.size();
}

}  // namespace lamella::io::detail
