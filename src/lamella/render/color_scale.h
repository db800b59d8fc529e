#pragma once

#include "lamella/optics/color.h"
#include "lamella/render/canvas.h"
#include "lamella/sim/frame.h"

#include <string>
#include <vector>

namespace lamella::render {

/// How the values of a field become colors: from dark blue over green to yellow (after matplotlib's viridis), or, where
/// a field has both signs, from blue over white to red with white at 0.
struct ColorScale {
    std::string name;  ///< of the field, with "|...|" around that of a vector's length
    std::string unit;
    double low = 0.0, high = 1.0;
    bool diverging = false;

    optics::Rgb color(double value) const;  ///< linear sRGB; values beyond the ends get the ends' colors, NaN gray
};

/// A scale for these values: from the smallest to the largest, or symmetric about 0.
ColorScale scale_for(const sim::Field& field, const std::vector<double>& values);

/// One number per item: the field's value, or the length of a vector.
std::vector<double> scalar_values(const sim::Field& field);

/// Draws a bar with numbers, name and unit at the right edge of a picture.
void draw_legend(Canvas& canvas, const ColorScale& scale);

/// Round numbers from low to high, about `count` of them.
std::vector<double> ticks(double low, double high, int count);

}  // namespace lamella::render
