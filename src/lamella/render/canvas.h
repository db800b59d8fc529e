#pragma once

#include "lamella/core/vec.h"
#include "lamella/io/image_files.h"

#include <array>
#include <string_view>
#include <vector>

namespace lamella::render {

/// A color for a screen: red, green, blue encoded as sRGB says, and opacity; all 0 to 1.
using ScreenColor = std::array<float, 4>;

/// A picture that text, lines and areas can be drawn on. (0, 0) is the upper left corner of the upper left pixel, y
/// points down, lengths are pixels. Edges are smooth; what lies outside is left out.
class Canvas {
public:
    Canvas(std::size_t width, std::size_t height, const ScreenColor& background);

    std::size_t width() const { return width_; }
    std::size_t height() const { return height_; }
    ScreenColor& at(std::size_t x, std::size_t y) { return pixels_[y * width_ + x]; }
    const ScreenColor& at(std::size_t x, std::size_t y) const { return pixels_[y * width_ + x]; }

    void fill(const Vec2& corner, const Vec2& opposite, const ScreenColor& color);
    /// A line with round ends.
    void draw_line(const Vec2& from, const Vec2& to, double thickness, const ScreenColor& color);
    /// Text whose capitals are `size` high and stand on `start`; ASCII, other bytes show as a small box.
    void draw_text(const Vec2& start, double size, std::string_view text, const ScreenColor& color);
    /// The same with its middle, or its end, at `place`.
    void draw_text_centered(const Vec2& place, double size, std::string_view text, const ScreenColor& color);
    void draw_text_ending(const Vec2& place, double size, std::string_view text, const ScreenColor& color);

    /// @param bits      8 or 16
    /// @param channels  3, or 4 to keep the opacity
    io::Raster raster(int bits, int channels) const;

private:
    std::size_t width_, height_;
    std::vector<ScreenColor> pixels_;
};

/// How wide draw_text makes a text.
double text_width(double size, std::string_view text);

}  // namespace lamella::render
