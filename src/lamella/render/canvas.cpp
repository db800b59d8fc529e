#include "lamella/render/canvas.h"

#include "lamella/render/detail/stroke_font.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lamella::render {
namespace {

constexpr double kCapital = 6.0;  ///< height of a capital in units of the font's grid
constexpr double kGap = 2.2;      ///< between two characters
constexpr double kSpace = 2.4;    ///< width of a space
constexpr double kPen = 0.11;     ///< thickness of a line, of the height of a capital

/// The points of a glyph one after the other; nothing separates two lines.
template <class Visit>
void visit_points(std::string_view strokes, Visit&& visit) {
    for (std::size_t i = 0; i < strokes.size();) {
        if (strokes[i] == ' ') {
            visit(std::optional<Vec2>());
            ++i;
        } else {
            visit(std::optional(
                Vec2{{static_cast<double>(strokes[i] - '0'), static_cast<double>(strokes[i + 1] - '0') - 2.0}}));
            i += 2;
        }
    }
}

double glyph_width(char character) {
    if (character == ' ') return kSpace;
    double width = 0.0;
    visit_points(detail::glyph_strokes(character), [&](const std::optional<Vec2>& p) {
        if (p) width = std::max(width, (*p)[0]);
    });
    return width;
}

double squared_distance_to_line(const Vec2& p, const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const double length = squared_norm(along);
    const double t = length > 0.0 ? std::clamp(dot(p - a, along) / length, 0.0, 1.0) : 0.0;
    return squared_norm(p - a - t * along);
}

/// Lays `color` over what is there, for the fraction `cover` of the pixel.
void blend(ScreenColor& under, const ScreenColor& color, double cover) {
    const float over = color[3] * static_cast<float>(cover);
    const float alpha = over + under[3] * (1.0F - over);
    if (alpha <= 0.0F) return;
    for (std::size_t k = 0; k < 3; ++k) under[k] = (over * color[k] + (1.0F - over) * under[3] * under[k]) / alpha;
    under[3] = alpha;
}

/// The pixels from `low` to `high`, cut to [0, count).
std::pair<std::size_t, std::size_t> pixel_range(double low, double high, std::size_t count) {
    const double last = static_cast<double>(count);
    return {static_cast<std::size_t>(std::clamp(std::floor(low), 0.0, last)),
            static_cast<std::size_t>(std::clamp(std::ceil(high), 0.0, last))};
}

}  // namespace

Canvas::Canvas(std::size_t width, std::size_t height, const ScreenColor& background)
    : width_(width), height_(height), pixels_(width * height, background) {}

void Canvas::fill(const Vec2& corner, const Vec2& opposite, const ScreenColor& color) {
    const auto [x0, x1] = pixel_range(corner[0], opposite[0], width_);
    const auto [y0, y1] = pixel_range(corner[1], opposite[1], height_);
    const auto covered = [](double low, double high, std::size_t pixel) {
        const auto p = static_cast<double>(pixel);
        return std::max(0.0, std::min(high, p + 1.0) - std::max(low, p));
    };
    for (std::size_t y = y0; y < y1; ++y)
        for (std::size_t x = x0; x < x1; ++x)
            blend(at(x, y), color, covered(corner[0], opposite[0], x) * covered(corner[1], opposite[1], y));
}

void Canvas::draw_line(const Vec2& from, const Vec2& to, double thickness, const ScreenColor& color) {
    const double reach = 0.5 * thickness + 1.0;
    const auto [x0, x1] = pixel_range(std::min(from[0], to[0]) - reach, std::max(from[0], to[0]) + reach, width_);
    const auto [y0, y1] = pixel_range(std::min(from[1], to[1]) - reach, std::max(from[1], to[1]) + reach, height_);
    for (std::size_t y = y0; y < y1; ++y)
        for (std::size_t x = x0; x < x1; ++x) {
            const Vec2 center{{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5}};
            const double distance = std::sqrt(squared_distance_to_line(center, from, to));
            blend(at(x, y), color, std::clamp(0.5 * thickness + 0.5 - distance, 0.0, 1.0));
        }
}

void Canvas::draw_text(const Vec2& start, double size, std::string_view text, const ScreenColor& color) {
    const double scale = size / kCapital;
    double pen_x = start[0];
    for (const char character : text) {
        std::optional<Vec2> before;
        visit_points(detail::glyph_strokes(character), [&](const std::optional<Vec2>& p) {
            if (p && before) {
                const auto placed = [&](const Vec2& q) {
                    return Vec2{{pen_x + scale * q[0], start[1] - scale * q[1]}};
                };
                draw_line(placed(*before), placed(*p), std::max(1.0, kPen * size), color);
            }
            before = p;
        });
        pen_x += scale * (glyph_width(character) + kGap);
    }
}

void Canvas::draw_text_centered(const Vec2& place, double size, std::string_view text, const ScreenColor& color) {
    draw_text({{place[0] - 0.5 * text_width(size, text), place[1]}}, size, text, color);
}

void Canvas::draw_text_ending(const Vec2& place, double size, std::string_view text, const ScreenColor& color) {
    draw_text({{place[0] - text_width(size, text), place[1]}}, size, text, color);
}

io::Raster Canvas::raster(int bits, int channels) const {
    io::Raster raster{width_, height_, channels, bits, {}};
    const float most = bits == 16 ? 65535.0F : 255.0F;
    raster.values.reserve(pixels_.size() * static_cast<std::size_t>(channels));
    for (const ScreenColor& pixel : pixels_)
        for (std::size_t k = 0; k < static_cast<std::size_t>(channels); ++k)
            raster.values.push_back(static_cast<std::uint16_t>(std::lround(most * std::clamp(pixel[k], 0.0F, 1.0F))));
    return raster;
}

double text_width(double size, std::string_view text) {
    double units = 0.0;
    for (const char character : text) units += glyph_width(character) + kGap;
    return text.empty() ? 0.0 : (units - kGap) * size / kCapital;
}

}  // namespace lamella::render
