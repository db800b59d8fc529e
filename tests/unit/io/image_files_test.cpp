#include "lamella/io/image_files.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>

#include "lamella/core/error.h"

namespace lamella::io {
namespace {

/// Decodes with libpng's simple interface, which the writer does not use. 8-bit RGBA.
std::vector<std::uint8_t> decoded(const std::string& bytes, std::uint32_t* width) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
    *width = image.width;
    return pixels;
}

Raster sample(int channels, int bits) {
    Raster raster{7, 3, channels, bits, {}};
    for (std::size_t i = 0; i < 21U * static_cast<std::size_t>(channels); ++i)
        raster.values.push_back(static_cast<std::uint16_t>(bits == 16 ? i * 257 : i * 3));
    return raster;
}

TEST(Png, IsReadBackByLibpng) {
    for (const int bits : {8, 16})
        for (const int channels : {3, 4}) {
            const Raster raster = sample(channels, bits);
            std::uint32_t width = 0;
            const auto pixels = decoded(png_bytes(raster), &width);
            ASSERT_EQ(width, 7U);
            for (std::size_t i = 0; i < 21; ++i)
                for (std::size_t k = 0; k < 3; ++k) {
                    const int value = raster.values[i * static_cast<std::size_t>(channels) + k];
                    EXPECT_EQ(pixels[4 * i + k], bits == 16 ? value / 257 : value);
                }
        }
}

TEST(Png, HasTheSameBytesEveryTime) { EXPECT_EQ(png_bytes(sample(3, 8)), png_bytes(sample(3, 8))); }

TEST(Png, OfAPictureThatContradictsItselfIsRefused) {
    Raster raster = sample(3, 8);
    raster.values.pop_back();
    EXPECT_THROW(png_bytes(raster), InputError);
    EXPECT_THROW(png_bytes({0, 0, 3, 8, {}}), InputError);
}

LightImage light() {
    LightImage image{5, 4, 4, {}};
    for (int i = 0; i < 80; ++i) image.values.push_back(static_cast<float>(std::exp(0.1 * i) - 2.0));
    return image;
}

TEST(Exr, IsReadBackExactly) {
    if (!has_exr()) GTEST_SKIP() << "built without OpenEXR";
    const LightImage written = light();
    const LightImage read = parse_light_image(exr_bytes(written), "x.exr");
    ASSERT_EQ(read.width, 5U);
    ASSERT_EQ(read.height, 4U);
    for (std::size_t y = 0; y < 4; ++y)
        for (std::size_t x = 0; x < 5; ++x)
            for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(read.pixel(x, y)[k], written.pixel(x, y)[k]);
}

TEST(Exr, ThatIsDamagedIsRefused) {
    if (!has_exr()) GTEST_SKIP() << "built without OpenEXR";
    const std::string whole = exr_bytes(light());
    for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 40)
        EXPECT_THROW(parse_light_image(whole.substr(0, length), "x.exr"), InputError) << length;
}

const std::string kHead = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n";

TEST(Radiance, IsReadFlat) {
    const LightImage image = parse_light_image(kHead + "-Y 1 +X 2\n" + std::string("\x80\x40\x20\x81\x00\x00\x00\x00", 8), "x.hdr");
    EXPECT_EQ(image.values, (std::vector<float>{1.0F, 0.5F, 0.25F, 0.0F, 0.0F, 0.0F}));
}

TEST(Radiance, IsReadWithRuns) {
    std::string row("\x02\x02\x00\x08", 4);
    row += std::string("\x88\x80", 2);                          // red: 8 times 128
    row += std::string("\x08\x01\x02\x03\x04\x05\x06\x07\x08", 9);  // green: 1 to 8
    row += std::string("\x88\x00", 2) + std::string("\x88\x80", 2);
    const LightImage image = parse_light_image(kHead + "-Y 1 +X 8\n" + row, "x.hdr");
    for (std::size_t x = 0; x < 8; ++x) {
        EXPECT_EQ(image.pixel(x, 0)[0], 0.5F);
        EXPECT_EQ(image.pixel(x, 0)[1], static_cast<float>(x + 1) / 256.0F);
    }
}

TEST(Radiance, ThatIsDamagedIsRefused) {
    const std::string pixels("\x80\x40\x20\x81\x00\x00\x00\x00", 8);
    for (const std::string& text :
         {std::string(), std::string("P6\n"), kHead, kHead + "-Y 1 +X 2\n" + pixels.substr(0, 7), kHead + "+Y 1 +X 2\n" + pixels,
          kHead + "-Y 0 +X 2\n", kHead + "-Y 99999 +X 99999\n" + pixels, kHead + "-Y -1 +X 2\n" + pixels,
          std::string("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n") + pixels,
          kHead + "-Y 1 +X 8\n" + std::string("\x02\x02\x00\x08\xff\x01", 6)})
        EXPECT_THROW(parse_light_image(text, "x.hdr"), InputError) << text;
    EXPECT_THROW(parse_light_image(pixels, "x.jpg"), InputError);
}

}  // namespace
}  // namespace lamella::io
