#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lamella::io::detail {

/// Characters that base64 takes for `bytes` bytes, padding included.
constexpr std::size_t base64_length(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

/// Appends the base64 text of `bytes` (RFC 4648, padded, no line breaks).
void append_base64(std::string& out, std::string_view bytes);

/// The `count` bytes that the first base64_length(count) characters of `text` stand for; nothing when the text is
/// shorter or not base64.
std::optional<std::string> decode_base64(std::string_view text, std::size_t count);

}  // namespace lamella::io::detail
