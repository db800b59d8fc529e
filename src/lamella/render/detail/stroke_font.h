#pragma once

#include <string_view>

namespace lamella::render::detail {

/// A character as lines on a grid: pairs of digits x, y make a polyline, a space begins the next. Capitals reach from
/// y = 2 (the line that text stands on) to y = 8, small letters to 6, descenders to 0. One point twice is a dot.
struct Glyph {
    char character;
    std::string_view strokes;
};

/// The lines of a character; a box for one that is not in the font, nothing for a space.
std::string_view glyph_strokes(char character);

}  // namespace lamella::render::detail
