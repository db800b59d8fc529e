#include "lamella/core/error.h"
#include "lamella/io/detail/light_image.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace lamella::io::detail {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Reads bytes and lines; asks for more than there is are damage.
class Reader {
public:
    Reader(std::string_view contents, const std::string& name) : rest_(contents), name_(name) {}

    [[noreturn]] void fail(const std::string& what) const { throw InputError(fmt::format("{}: {}", name_, what)); }

    std::string_view line() {
        const std::size_t end = rest_.find('\n');
        if (end == std::string_view::npos) fail("the header of a Radiance picture does not end");
        const std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return text;
    }
    std::uint8_t byte() {
        if (rest_.empty()) fail("a Radiance picture ends before its last pixel");
        const auto value = static_cast<std::uint8_t>(rest_.front());
        rest_.remove_prefix(1);
        return value;
    }
    std::string_view rest() const { return rest_; }

private:
    std::string_view rest_;
    const std::string& name_;
};

/// "-Y 512 +X 1024"
LightImage sized_image(Reader& reader) {
    const std::string_view text = reader.line();
    LightImage image;
    const std::size_t across = text.find(" +X ");
    const auto number = [&](std::string_view digits, std::size_t& value) {
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return error == std::errc{} && end == digits.data() + digits.size() && value > 0 && value < (1U << 20);
    };
    if (!text.starts_with("-Y ") || across == std::string_view::npos ||
        !number(text.substr(3, across - 3), image.height) || !number(text.substr(across + 4), image.width))
        reader.fail(fmt::format("\"{}\" is no size of a Radiance picture such as \"-Y 512 +X 1024\"", text.substr(0, 40)));
    // A row takes at least 4 bytes for a run of 127 pixels in each channel: what is shorter is damaged.
    if (image.width * image.height > kMostPixels || reader.rest().size() < image.width * image.height / 127 * 4 / 2)
        reader.fail(fmt::format("{} x {} pixels are more than the file holds", image.width, image.height));
    image.values.resize(image.width * image.height * 3);
    return image;
}

/// A row whose four channels are encoded one after the other.
void read_runs(Reader& reader, std::vector<Rgbe>& row) {
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t x = 0; x < row.size();) {
            std::size_t count = reader.byte();
            const bool run = count > 128;
            if (run) count -= 128;
            if (count == 0 || count > row.size() - x) reader.fail("a run of pixels is longer than its row");
            const std::uint8_t repeated = run ? reader.byte() : std::uint8_t{0};
            for (std::size_t k = 0; k < count; ++k) row[x++][channel] = run ? repeated : reader.byte();
        }
}

void read_row(Reader& reader, std::vector<Rgbe>& row) {
    Rgbe first{};
    for (std::uint8_t& b : first) b = reader.byte();
    const bool runs = first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (runs) {
        if (static_cast<std::size_t>(first[2]) * 256 + first[3] != row.size()) reader.fail("a row has another length than the picture");
        return read_runs(reader, row);
    }
    row[0] = first;
    for (std::size_t x = 1; x < row.size(); ++x)
        for (std::uint8_t& b : row[x]) b = reader.byte();
}

}  // namespace

LightImage parse_radiance(std::string_view contents, const std::string& name) {
    Reader reader(contents, name);
    if (!reader.line().starts_with("#?")) reader.fail("this is no Radiance picture: it does not begin with #?");
    for (std::string_view line = reader.line(); !line.empty(); line = reader.line())
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
            reader.fail(fmt::format("{} is not understood, only 32-bit_rle_rgbe", line.substr(0, 40)));
    LightImage image = sized_image(reader);
    std::vector<Rgbe> row(image.width);
    for (std::size_t y = 0; y < image.height; ++y) {
        read_row(reader, row);
        for (std::size_t x = 0; x < image.width; ++x) {
            const float scale = row[x][3] == 0 ? 0.0F : std::ldexp(1.0F, row[x][3] - (128 + 8));
            for (std::size_t k = 0; k < 3; ++k) image.pixel(x, y)[k] = scale * static_cast<float>(row[x][k]);
        }
    }
    return image;
}

}  // namespace lamella::io::detail
