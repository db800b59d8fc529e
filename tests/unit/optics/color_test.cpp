#include "lamella/optics/color.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lamella/core/error.h"
#include "lamella/optics/spectrum.h"

namespace lamella::optics {
namespace {

TEST(Color, GoesToXyzAndBack) {
    for (const Rgb& c : {Rgb{{1, 0, 0}}, Rgb{{0.2, 0.7, 0.1}}, Rgb{{-0.3, 1.2, 2.0}}}) {
        const Rgb back = linear_srgb(xyz_of(c));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[k], c[k], 1e-14);
    }
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(xyz_of({{1, 1, 1}})[k], kSrgbWhite[k], 1e-6);
}

TEST(Color, KeepsWhiteWhiteWhenTheLightChanges) {
    for (const Xyz& white : {Xyz{{1.09850, 1.0, 0.35585}}, Xyz{{0.9, 1.0, 1.3}}}) {
        const Xyz seen = adapt_white(0.5 * white, white);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], 0.5 * kSrgbWhite[k], 1e-14);
    }
    // Lindbloom's matrix from A to D65 takes this color there; his digits end at 1e-7.
    const Xyz d65 = adapt_white({{0.5, 0.4, 0.1}}, {{1.09850, 1.0, 0.35585}});
    EXPECT_NEAR(d65[0], 0.8446965 * 0.5 - 0.1179225 * 0.4 + 0.3948108 * 0.1, 2e-5);
    EXPECT_NEAR(d65[1], -0.1366303 * 0.5 + 1.1041226 * 0.4 + 0.1291718 * 0.1, 2e-5);
    EXPECT_NEAR(d65[2], 0.0798489 * 0.5 - 0.1348999 * 0.4 + 3.1924009 * 0.1, 2e-5);
}

TEST(Color, LosesSaturationAndNotLuminanceWhenAScreenCannotShowIt) {
    for (double r = -0.5; r <= 1.5; r += 0.25)
        for (double g = -0.5; g <= 1.5; g += 0.25)
            for (double b = -0.5; b <= 1.5; b += 0.25) {
                const Rgb color{{r, g, b}};
                const double y = luminance(color);
                const Rgb shown = desaturate(color);
                EXPECT_NEAR(luminance(shown), std::fmin(std::fmax(y, 0.0), 1.0), 1e-6);  // the row of Y adds up to 1.0000001
                for (const double c : shown.v) EXPECT_TRUE(c >= 0.0 && c <= 1.0);
                const bool can_be_shown = r >= 0 && g >= 0 && b >= 0 && r <= 1 && g <= 1 && b <= 1;
                if (can_be_shown) {
                    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(shown[k], color[k], 1e-15);
                }
            }
}

TEST(Color, IsEncodedAsTheStandardSays) {
    EXPECT_NEAR(encode_srgb(0.5), 0.7353569830524495, 1e-12);
    EXPECT_NEAR(encode_srgb(0.002), 0.02584, 1e-12);
    for (double x = 0.0; x <= 1.0; x += 0.01) EXPECT_NEAR(decode_srgb(encode_srgb(x)), x, 1e-7);  // the knee's rounding
    EXPECT_EQ(display_color({{1, 1, 1}}), (std::array<std::uint8_t, 3>{255, 255, 255}));
    EXPECT_EQ(display_color({{0.2158605, 0, 0}}), (std::array<std::uint8_t, 3>{128, 0, 0}));
}

TEST(Color, DiffersInLab) {
    const Lab red = lab(xyz_of({{1, 0, 0}}), kSrgbWhite);  // the values of every converter
    EXPECT_NEAR(red.lightness, 53.24, 0.01);
    EXPECT_NEAR(red.a, 80.09, 0.01);
    EXPECT_NEAR(red.b, 67.20, 0.01);
    EXPECT_NEAR(difference_76(red, lab(kSrgbWhite, kSrgbWhite)), std::hypot(100 - 53.24, 80.09, 67.20), 0.02);
}

TEST(Color, HasAName) {
    EXPECT_EQ(color_name({{0, 0, 0}}), "black");
    EXPECT_EQ(color_name({{0.2, 0.2, 0.2}}), "gray");
    EXPECT_EQ(color_name({{1, 1, 1}}), "white");
    EXPECT_EQ(color_name({{1, 1, 0}}), "yellow");
    EXPECT_EQ(color_name({{0, 1, 0}}), "green");
    EXPECT_EQ(color_name({{0, 0.1, 1}}), "violet");  // sRGB's blue lies at 306 degrees
    EXPECT_EQ(color_name({{0.05, 0.3, 0.8}}), "blue");
}

TEST(Illuminant, HasItsChromaticity) {
    const auto xy = [](const std::string& name) {
        Vec3 sum;
        const Illuminant light = illuminant(name);
        for (std::size_t i = 0; i < kWavelengths; ++i) {
            const Matching m = color_matching(wavelength_nm(i));
            sum += light.power[i] * Vec3{{m.x, m.y, m.z}};
        }
        const double all = sum[0] + sum[1] + sum[2];
        return Vec2{{sum[0] / all, sum[1] / all}};
    };
    // The matching functions are a fit: their whites are off by a few thousandths.
    EXPECT_LT(norm(xy("D65") - Vec2{{0.3127, 0.3290}}), 3e-3);
    EXPECT_LT(norm(xy("A") - Vec2{{0.4476, 0.4074}}), 3e-3);
    EXPECT_LT(norm(xy("E") - Vec2{{1.0 / 3.0, 1.0 / 3.0}}), 3e-3);
    EXPECT_LT(norm(xy("6500 K") - Vec2{{0.3135, 0.3237}}), 3e-3);  // Planck's locus
}

TEST(Illuminant, ThatDoesNotExistIsRefused) {
    for (const char* name : {"", "D66", "5000", "100 K", "1e9 K", "nan K", "5000 kK"}) EXPECT_THROW(illuminant(name), InputError) << name;
}

}  // namespace
}  // namespace lamella::optics
