#include "lamella/core/error.h"
#include "lamella/io/image_files.h"

#include <png.h>

#include <csetjmp>
#include <new>

namespace lamella::io {
namespace {

/// Owns what libpng allocates.
class PngWriter {
public:
    PngWriter() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr)) {
        if (png_ == nullptr || (info_ = png_create_info_struct(png_)) == nullptr) throw std::bad_alloc();
    }
    ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    png_structp png() const { return png_; }
    png_infop info() const { return info_; }

private:
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

void append(png_structp png, png_bytep bytes, std::size_t count) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

void flush(png_structp) {}

/// The picture's integers as PNG stores them: one byte each, or two, high byte first.
std::vector<png_byte> packed(const Raster& picture) {
    std::vector<png_byte> bytes;
    bytes.reserve(picture.values.size() * (picture.bits == 16 ? 2 : 1));
    for (const std::uint16_t value : picture.values) {
        if (picture.bits == 16) bytes.push_back(static_cast<png_byte>(value >> 8));
        bytes.push_back(static_cast<png_byte>(value & 0xff));
    }
    return bytes;
}

/// libpng leaves by longjmp when something is wrong; nothing with a destructor lives in here.
bool write_rows(const PngWriter& writer, const Raster& picture, png_byte* rows, std::size_t row_bytes, std::string* out) {
    constexpr int kColorTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    if (setjmp(png_jmpbuf(writer.png())) != 0) return false;
    png_set_write_fn(writer.png(), out, append, flush);
    png_set_IHDR(writer.png(), writer.info(), static_cast<png_uint_32>(picture.width),
                 static_cast<png_uint_32>(picture.height), picture.bits, kColorTypes[picture.channels - 1],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(writer.png(), writer.info(), PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(writer.png(), writer.info());
    for (std::size_t y = 0; y < picture.height; ++y) png_write_row(writer.png(), rows + y * row_bytes);
    png_write_end(writer.png(), nullptr);
    return true;
}

}  // namespace

std::string png_bytes(const Raster& picture) {
    constexpr std::size_t kLargest = 1U << 20;  // pixels along a side
    const auto channels = static_cast<std::size_t>(picture.channels);
    if (picture.channels < 1 || picture.channels > 4 || (picture.bits != 8 && picture.bits != 16) || picture.width == 0 ||
        picture.height == 0 || picture.width > kLargest || picture.height > kLargest ||
        picture.values.size() != picture.width * picture.height * channels)
        throw InputError("the size of a picture does not fit its values");
    std::vector<png_byte> rows = packed(picture);
    std::string bytes;
    const PngWriter writer;
    if (!write_rows(writer, picture, rows.data(), rows.size() / picture.height, &bytes))
        throw IoError("libpng cannot compress a picture");
    return bytes;
}

}  // namespace lamella::io
