#include "lamella/optics/color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::optics {
namespace {

using Matrix = std::array<Vec3, 3>;  // rows

// IEC 61966-2-1, with the digits that make its white (0.95047, 1, 1.08883); the second is the inverse of the first.
constexpr Matrix kFromRgb{{{{0.4124564, 0.3575761, 0.1804375}},
                           {{0.2126729, 0.7151522, 0.0721750}},
                           {{0.0193339, 0.1191920, 0.9503041}}}};
// Cone-like responses of the Bradford transform, and back.
constexpr Matrix kBradford{
    {{{0.8951, 0.2664, -0.1614}}, {{-0.7502, 1.7135, 0.0367}}, {{0.0389, -0.0685, 1.0296}}}};

Vec3 apply(const Matrix& m, const Vec3& v) { return {{dot(m[0], v), dot(m[1], v), dot(m[2], v)}}; }

/// x with m x = v, by Cramer's rule.
Vec3 solve(const Matrix& m, const Vec3& v) {
    const auto column = [&](std::size_t k) { return Vec3{{m[0][k], m[1][k], m[2][k]}}; };
    const Vec3 a = column(0), b = column(1), c = column(2);
    const double determinant = dot(a, cross(b, c));
    return {{dot(v, cross(b, c)) / determinant, dot(a, cross(v, c)) / determinant, dot(a, cross(b, v)) / determinant}};
}

double lab_curve(double t) {
    constexpr double kKnee = 6.0 / 29.0;
    return t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3.0 * kKnee * kKnee) + 4.0 / 29.0;
}

}  // namespace

Rgb linear_srgb(const Xyz& color) { return solve(kFromRgb, color); }

Xyz xyz_of(const Rgb& color) { return apply(kFromRgb, color); }

double luminance(const Rgb& color) { return dot(kFromRgb[1], color); }

Xyz adapt_white(const Xyz& color, const Xyz& white) {
    const Vec3 from = apply(kBradford, white);
    const Vec3 to = apply(kBradford, kSrgbWhite);
    Vec3 response = apply(kBradford, color);
    for (std::size_t k = 0; k < 3; ++k) response[k] *= to[k] / from[k];
    return solve(kBradford, response);
}

Rgb desaturate(const Rgb& color) {
    const double gray = std::clamp(luminance(color), 0.0, 1.0);
    double keep = 1.0;  // of the distance from gray
    for (const double c : color.v) {
        if (c < 0.0) keep = std::min(keep, gray / (gray - c));
        if (c > 1.0) keep = std::min(keep, (1.0 - gray) / (c - gray));
    }
    Rgb mapped;
    for (std::size_t k = 0; k < 3; ++k) mapped[k] = std::clamp(gray + keep * (color[k] - gray), 0.0, 1.0);
    return mapped;
}

double encode_srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double decode_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

std::array<std::uint8_t, 3> display_color(const Rgb& color) {
    const Rgb shown = desaturate(color);
    std::array<std::uint8_t, 3> bytes{};
    for (std::size_t k = 0; k < 3; ++k) bytes[k] = static_cast<std::uint8_t>(std::lround(255.0 * encode_srgb(shown[k])));
    return bytes;
}

Lab lab(const Xyz& color, const Xyz& white) {
    const double x = lab_curve(color[0] / white[0]), y = lab_curve(color[1] / white[1]),
                 z = lab_curve(color[2] / white[2]);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double difference_76(const Lab& one, const Lab& other) {
    return std::hypot(one.lightness - other.lightness, one.a - other.a, one.b - other.b);
}

std::string_view color_name(const Rgb& color) {
    const Lab c = lab(xyz_of(color), kSrgbWhite);
    const double chroma = std::hypot(c.a, c.b);
    if (c.lightness < 12.0) return "black";
    if (chroma < 9.0) return c.lightness < 70.0 ? "gray" : "white";
    double hue = std::atan2(c.b, c.a) * 180.0 / std::numbers::pi;
    if (hue < 0.0) hue += 360.0;
    struct Sector {
        double end;  // [deg]
        std::string_view name;
    };
    constexpr std::array<Sector, 9> kSectors{{{20.0, "crimson"},
                                              {50.0, "red"},
                                              {78.0, "amber"},
                                              {112.0, "yellow"},
                                              {165.0, "green"},
                                              {225.0, "turquoise"},
                                              {292.0, "blue"},
                                              {328.0, "violet"},
                                              {352.0, "magenta"}}};
    for (const Sector& sector : kSectors)
        if (hue < sector.end) return sector.name;
    return "crimson";
}

}  // namespace lamella::optics
