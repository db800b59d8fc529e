#include "lamella/render/color_chart.h"

#include "lamella/core/parallel.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace lamella::render {
namespace {

constexpr double kThickest = 1500e-9;  // [m]
constexpr double kSteepest = 85.0;     // [deg]
constexpr double kThickFilmShown = 0.45;

constexpr ScreenColor kPaper{0.09F, 0.09F, 0.10F, 1.0F};
constexpr ScreenColor kInk{0.92F, 0.92F, 0.90F, 1.0F};
constexpr ScreenColor kDim{0.62F, 0.62F, 0.60F, 1.0F};

ScreenColor screen_color(const optics::Rgb& color) {
    const optics::Rgb shown = optics::desaturate(color);
    ScreenColor encoded{0, 0, 0, 1};
    for (std::size_t k = 0; k < 3; ++k) encoded[k] = static_cast<float>(optics::encode_srgb(shown[k]));
    return encoded;
}

/// A film's color, brightened so that a thick film of that angle is kThickFilmShown bright.
optics::Rgb shown_film(const optics::FilmColors& film, double thickness, double cosine) {
    return kThickFilmShown / optics::luminance(film.reflected_by_thick_film(cosine)) *
           film.reflected(thickness, cosine);
}

struct Area {
    double left, top, right, bottom;
};

/// Paints color(u, v) with u to the right and v down, 0 to 1.
template <class Color>
void paint(Canvas& canvas, const Area& area, Color&& color) {
    const auto x0 = static_cast<std::size_t>(area.left), x1 = static_cast<std::size_t>(area.right);
    const auto y0 = static_cast<std::size_t>(area.top), y1 = static_cast<std::size_t>(area.bottom);
    parallel_blocks(y1 - y0, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (std::size_t x = x0; x < x1; ++x)
                canvas.at(x, y0 + row) = color((static_cast<double>(x - x0) + 0.5) / static_cast<double>(x1 - x0),
                                               (static_cast<double>(row) + 0.5) / static_cast<double>(y1 - y0));
    });
}

}  // namespace

Canvas color_chart(const optics::FilmLight& film, std::size_t width, std::size_t height) {
    const optics::FilmColors colors(film);
    Canvas canvas(width, height, kPaper);
    const double w = static_cast<double>(width), h = static_cast<double>(height);
    const double size = 0.022 * h;
    const Area strip{std::floor(0.075 * w), std::floor(0.13 * h), std::floor(0.965 * w), std::floor(0.25 * h)};
    const Area map{strip.left, std::floor(0.34 * h), strip.right, std::floor(0.88 * h)};
    std::vector<ScreenColor> normal(static_cast<std::size_t>(strip.right - strip.left));
    for (std::size_t x = 0; x < normal.size(); ++x)
        normal[x] = screen_color(
            shown_film(colors, kThickest * (static_cast<double>(x) + 0.5) / static_cast<double>(normal.size()), 1.0));
    paint(canvas, strip,
          [&](double u, double) { return normal[static_cast<std::size_t>(u * static_cast<double>(normal.size()))]; });
    paint(canvas, map, [&](double u, double v) {
        return screen_color(shown_film(colors, u * kThickest, std::cos(kSteepest * v * std::numbers::pi / 180.0)));
    });

    canvas.draw_text({{strip.left, 0.085 * h}}, 1.5 * size, "Colors of soap films", kInk);
    canvas.draw_text_ending(
        {{strip.right, 0.085 * h}}, size,
        fmt::format("light {}, liquid with index {:.3f} at 555 nm", film.light.name, colors.index(35)), kDim);
    for (int nm = 0; nm <= 1500; nm += 100) {
        const double x = strip.left + (strip.right - strip.left) * nm / 1500.0;
        canvas.draw_line({{x, strip.bottom + 0.2 * size}}, {{x, strip.bottom + 0.7 * size}}, 1.5, kDim);
        canvas.draw_line({{x, map.top - 0.7 * size}}, {{x, map.top - 0.2 * size}}, 1.5, kDim);
        canvas.draw_text_centered({{x, strip.bottom + 2.4 * size}}, size, fmt::format("{}", nm), kInk);
    }
    canvas.draw_text_centered({{0.5 * (map.left + map.right), map.bottom + 2.6 * size}}, size, "thickness [nm]", kInk);
    for (int degrees = 0; degrees <= 80; degrees += 20) {
        const double y = map.top + (map.bottom - map.top) * degrees / kSteepest;
        canvas.draw_line({{map.left - 0.7 * size, y}}, {{map.left - 0.2 * size, y}}, 1.5, kDim);
        canvas.draw_text_ending({{map.left - 1.2 * size, y + 0.5 * size}}, size, fmt::format("{}", degrees), kInk);
    }
    canvas.draw_text({{map.left, map.bottom + 2.6 * size}}, size, "rows: angle of incidence [deg]", kDim);
    canvas.draw_text_ending({{map.right, map.bottom + 2.6 * size}}, size, "a thick film is gray in every row", kDim);
    return canvas;
}

std::vector<ChartRow> color_rows(const optics::FilmLight& film, double step) {
    const optics::FilmColors colors(film);
    std::vector<ChartRow> rows;
    for (int i = 0; i * step <= kThickest * (1.0 + 1e-12); ++i) {
        const double thickness = i * step;
        const optics::Rgb shown = shown_film(colors, thickness, 1.0);
        rows.push_back({thickness, optics::luminance(colors.reflected(thickness, 1.0)), optics::display_color(shown),
                        std::string(optics::color_name(shown))});
    }
    return rows;
}

}  // namespace lamella::render
