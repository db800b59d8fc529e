#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::io {

/// A picture as screens show it: integers encoded as sRGB says, row by row from the top.
struct Raster {
    std::size_t width = 0;
    std::size_t height = 0;
    int channels = 3;                   ///< 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha (not premultiplied)
    int bits = 8;                       ///< 8 or 16 per channel
    std::vector<std::uint16_t> values;  ///< width * height * channels, each below 2^bits
};

/// A picture of light: linear, not bounded, row by row from the top.
struct LightImage {
    std::size_t width = 0;
    std::size_t height = 0;
    int channels = 3;           ///< 3 RGB, 4 RGB and alpha (premultiplied)
    std::vector<float> values;  ///< width * height * channels

    const float* pixel(std::size_t x, std::size_t y) const {
        return &values[(y * width + x) * static_cast<std::size_t>(channels)];
    }
    float* pixel(std::size_t x, std::size_t y) { return &values[(y * width + x) * static_cast<std::size_t>(channels)]; }
};

/// The bytes of a PNG file: sRGB, compressed with the same bits every time.
std::string png_bytes(const Raster& picture);

/// The bytes of an OpenEXR file with channels R, G, B (and A) of 32 bits, ZIP-compressed.
/// @throws InputError  this program was built without OpenEXR
std::string exr_bytes(const LightImage& picture);

/// Whether this program can read and write OpenEXR files.
bool has_exr();

/// Reads a picture of light: Radiance (.hdr, .pic) or OpenEXR (.exr), by the file's suffix. Always 3 channels.
/// @throws InputError  not such a file, damaged, larger than 2^28 pixels; EXR without OpenEXR   @throws IoError
LightImage read_light_image(const std::filesystem::path& path);
/// The same from memory (tests, fuzzing); the suffix of `name` says what it is, and `name` stands for the file in messages.
LightImage parse_light_image(std::string_view contents, const std::string& name);

}  // namespace lamella::io
