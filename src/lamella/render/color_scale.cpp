#include "lamella/render/color_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lamella::render {
namespace {

using Encoded = std::array<int, 3>;

// Nine colors each, evenly spaced; encoded sRGB.
constexpr std::array<Encoded, 9> kOneSided{{{68, 1, 84},
                                            {71, 44, 122},
                                            {59, 81, 139},
                                            {44, 113, 142},
                                            {33, 144, 141},
                                            {39, 173, 129},
                                            {92, 200, 99},
                                            {170, 220, 50},
                                            {253, 231, 37}}};
constexpr std::array<Encoded, 9> kTwoSided{{{24, 60, 140},
                                            {48, 108, 184},
                                            {96, 157, 208},
                                            {170, 206, 228},
                                            {242, 242, 240},
                                            {244, 194, 168},
                                            {222, 126, 98},
                                            {186, 58, 58},
                                            {126, 14, 38}}};

optics::Rgb decoded(const std::array<Encoded, 9>& colors, double place) {
    const double at = std::clamp(place, 0.0, 1.0) * 8.0;
    const auto i = std::min(static_cast<std::size_t>(at), std::size_t{7});
    const double rest = at - static_cast<double>(i);
    optics::Rgb color;
    for (std::size_t k = 0; k < 3; ++k)
        color[k] = optics::decode_srgb(((1.0 - rest) * colors[i][k] + rest * colors[i + 1][k]) / 255.0);
    return color;
}

}  // namespace

optics::Rgb ColorScale::color(double value) const {
    if (std::isnan(value)) return {{0.2, 0.2, 0.2}};
    const double place = high > low ? (value - low) / (high - low) : 0.5;
    return decoded(diverging ? kTwoSided : kOneSided, place);
}

std::vector<double> scalar_values(const sim::Field& field) {
    if (field.components == 1) return field.values;
    const auto n = static_cast<std::size_t>(field.components);
    std::vector<double> lengths(field.values.size() / n);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        double square = 0.0;
        for (std::size_t k = 0; k < n; ++k) square += field.values[n * i + k] * field.values[n * i + k];
        lengths[i] = std::sqrt(square);
    }
    return lengths;
}

ColorScale scale_for(const sim::Field& field, const std::vector<double>& values) {
    ColorScale scale;
    scale.name = field.components == 1 ? field.name : "|" + field.name + "|";
    scale.unit = field.unit;
    scale.low = std::numeric_limits<double>::infinity();
    scale.high = -scale.low;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        scale.low = std::min(scale.low, value);
        scale.high = std::max(scale.high, value);
    }
    if (!(scale.low <= scale.high)) scale.low = scale.high = 0.0;
    scale.diverging = scale.low < 0.0 && scale.high > 0.0;
    if (scale.diverging) {
        scale.high = std::max(-scale.low, scale.high);
        scale.low = -scale.high;
    }
    return scale;
}

std::vector<double> ticks(double low, double high, int count) {
    if (!(high > low)) return {low};
    const double raw = (high - low) / count, power = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10.0 * power;
    for (const double nice : {5.0, 2.0, 1.0})
        if (nice * power >= raw * 0.999) step = nice * power;
    std::vector<double> list;
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0)
        list.push_back(k * step + 0.0);
    return list;
}

void draw_legend(Canvas& canvas, const ColorScale& scale) {
    const double w = static_cast<double>(canvas.width()), h = static_cast<double>(canvas.height());
    const double size = std::max(8.0, 0.021 * h);
    const double left = w - 6.5 * size, right = left + 1.1 * size, top = 0.22 * h, bottom = 0.78 * h;
    constexpr ScreenColor kInk{0.93F, 0.93F, 0.92F, 1.0F}, kShade{0.06F, 0.06F, 0.07F, 0.62F};
    const std::string title = scale.unit == "-" ? scale.name : fmt::format("{} [{}]", scale.name, scale.unit);
    const double title_width = text_width(size, title);
    const double panel = std::min(left - size, w - size - title_width - size);
    canvas.fill({{panel, top - 3.4 * size}}, {{w, bottom + 1.6 * size}}, kShade);
    canvas.draw_text_ending({{w - size, top - 1.5 * size}}, size, title, kInk);
    for (double y = top; y < bottom; y += 1.0) {
        const double place = (bottom - y - 0.5) / (bottom - top);
        const optics::Rgb color = scale.color(scale.low + place * (scale.high - scale.low));
        ScreenColor encoded{0, 0, 0, 1};
        for (std::size_t k = 0; k < 3; ++k)
            encoded[k] = static_cast<float>(optics::encode_srgb(std::clamp(color[k], 0.0, 1.0)));
        canvas.fill({{left, y}}, {{right, std::min(y + 1.0, bottom)}}, encoded);
    }
    for (const double value : ticks(scale.low, scale.high, 5)) {
        const double place = scale.high > scale.low ? (value - scale.low) / (scale.high - scale.low) : 0.5;
        const double y = bottom - place * (bottom - top);
        canvas.draw_line({{right + 0.2 * size, y}}, {{right + 0.6 * size, y}}, std::max(1.0, 0.1 * size), kInk);
        canvas.draw_text({{right + 1.0 * size, y + 0.42 * size}}, 0.85 * size, fmt::format("{:.4g}", value), kInk);
    }
}

}  // namespace lamella::render
