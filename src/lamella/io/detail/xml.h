#pragma once

#include "lamella/core/error.h"

#include <map>
#include <string>
#include <string_view>

namespace lamella::io::detail {

/// Whether `text` is UTF-8 without control characters: the only text that XML can hold unchanged.
bool is_printable(std::string_view text);

/// Printable text as it stands inside an XML attribute or element.
std::string xml_escaped(std::string_view text);

/// A start tag, an end tag, or the text between two tags.
struct XmlToken {
    enum class Kind { kStart, kEnd, kText, kEndOfFile };
    Kind kind = Kind::kEndOfFile;
    std::string name = {};                               ///< of a tag
    std::map<std::string, std::string> attributes = {};  ///< of a start tag
    bool empty_element = false;                          ///< <name/>: no end tag follows
    std::string text = {};                               ///< without white space at its ends
};

/// Takes apart the XML that lamella writes: elements, attributes, text, the five named entities.
/// Declarations and comments are skipped; there are no DTDs, so no entity can expand.
class XmlScanner {
public:
    /// @param name  the file, for messages. Both must outlive the scanner.
    XmlScanner(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    /// The next token; text that is only white space is skipped. @throws InputError  not well-formed (file:line)
    XmlToken next();
    /// The text that was not yet looked at.
    std::string_view rest() const { return text_.substr(position_); }
    /// An error at the place of the last token.
    InputError error(const std::string& message) const;

private:
    XmlToken tag();
    std::string unescaped(std::string_view text) const;
    std::string_view word();
    void skip_space();
    bool take(std::string_view expected);
    void skip_past(std::string_view end);

    std::string_view text_;
    const std::string& name_;
    std::size_t position_ = 0;
    std::size_t token_ = 0;
};

}  // namespace lamella::io::detail
