#pragma once

#include "lamella/core/vec.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace lamella::optics {

/// CIE 1931 tristimulus values; the white in use has Y = 1.
using Xyz = Vec3;
/// Light as red, green and blue of sRGB before the transfer curve. Signed: a color outside the triangle of these three
/// has a negative part, which must stay until the last sum is done. White is (1, 1, 1).
using Rgb = Vec3;

/// The white point of sRGB, D65 as the standard rounds it.
inline constexpr Xyz kSrgbWhite{{0.95047, 1.0, 1.08883}};

Rgb linear_srgb(const Xyz& color);
Xyz xyz_of(const Rgb& color);
/// Y of a color.
double luminance(const Rgb& color);

/// What `color`, seen under a light whose white is `white`, looks like to an eye adapted to sRGB's white: the linear
/// Bradford transform. White goes to white exactly (to rounding).
Xyz adapt_white(const Xyz& color, const Xyz& white);

/// The nearest color of the same luminance that sRGB can show, on the line to gray: only for display, at the very end,
/// as the sum of mapped colors is not the mapped sum. A luminance beyond [0, 1] is cut to it.
Rgb desaturate(const Rgb& color);

/// The transfer curve of sRGB and its inverse, for one channel within [0, 1].
double encode_srgb(double linear);
double decode_srgb(double encoded);

/// A color for a screen of 8 bits per channel: desaturated, encoded, rounded.
std::array<std::uint8_t, 3> display_color(const Rgb& color);

/// CIE 1976 L*a*b*.
struct Lab {
    double lightness = 0.0, a = 0.0, b = 0.0;
};
Lab lab(const Xyz& color, const Xyz& white);
/// CIE 1976 color difference: about 2.3 can just be seen.
double difference_76(const Lab& one, const Lab& other);

/// What one would call a color: "black", "gray", "white", "yellow", ... from lightness, chroma and hue in L*a*b*.
std::string_view color_name(const Rgb& color);

}  // namespace lamella::optics
