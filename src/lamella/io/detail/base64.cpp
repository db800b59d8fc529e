#include "lamella/io/detail/base64.h"

#include "lamella/core/parallel.h"

#include <array>
#include <cstdint>

namespace lamella::io::detail {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kBad = 0xFF;
constexpr std::size_t kGroups = 32768;  ///< of three bytes, one parallel block

constexpr std::array<std::uint8_t, 256> digit_values() {
    std::array<std::uint8_t, 256> values{};
    values.fill(kBad);
    for (std::size_t i = 0; i < kDigits.size(); ++i) values[static_cast<unsigned char>(kDigits[i])] = std::uint8_t(i);
    return values;
}
constexpr std::array<std::uint8_t, 256> kValues = digit_values();

/// The four digits of up to three bytes, missing ones taken as zero.
void encode_group(const char* in, std::size_t bytes, char* out) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < bytes ? static_cast<unsigned char>(in[k]) : 0U);
    for (int k = 3; k >= 0; --k, group >>= 6) out[k] = kDigits[group & 63U];
}

/// The bytes of a group of four digits; false when one of the first bytes + 1 is no digit.
bool decode_group(const char* in, std::size_t bytes, char* out) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint8_t value = k <= bytes ? kValues[static_cast<unsigned char>(in[k])] : std::uint8_t{0};
        if (value == kBad) return false;
        group = group << 6 | value;
    }
    for (std::size_t k = 0; k < bytes; ++k) out[k] = static_cast<char>(group >> (16 - 8 * k) & 0xFFU);
    return true;
}

}  // namespace

void append_base64(std::string& out, std::string_view bytes) {
    const std::size_t start = out.size();
    out.resize(start + base64_length(bytes.size()));
    char* const text = out.data() + start;
    const std::size_t whole = bytes.size() / 3;
    parallel_blocks(whole, kGroups, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) encode_group(bytes.data() + 3 * i, 3, text + 4 * i);
    });
    if (const std::size_t rest = bytes.size() % 3; rest > 0) {
        encode_group(bytes.data() + 3 * whole, rest, text + 4 * whole);
        for (std::size_t k = rest + 1; k < 4; ++k) text[4 * whole + k] = '=';
    }
}

std::optional<std::string> decode_base64(std::string_view text, std::size_t count) {
    if (count / 3 > text.size() / 4 || base64_length(count) > text.size()) return std::nullopt;
    std::string bytes(count, '\0');
    const std::size_t whole = count / 3;
    for (std::size_t i = 0; i < whole; ++i) {
        if (!decode_group(text.data() + 4 * i, 3, bytes.data() + 3 * i)) return std::nullopt;
    }
    if (const std::size_t rest = count % 3; rest > 0) {
        if (!decode_group(text.data() + 4 * whole, rest, bytes.data() + 3 * whole)) return std::nullopt;
    }
    return bytes;
}

}  // namespace lamella::io::detail
