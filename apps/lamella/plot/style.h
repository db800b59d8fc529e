#pragma once

#include <string>

namespace lamella::app {

/// A part of a picture: a gnuplot script without terminal, drawn alone or as one of several.
struct Panel {
    std::string name;  ///< of its file, "growth"
    std::string script;
    double aspect = 1.25;  ///< width over height when drawn alone
};

/// What every panel begins with: frame, tics, fonts, margins, line types, color map.
std::string panel_style();

/// The color of x in [0, 1] on the color map (viridis: even steps look even, also in gray and to the color-blind),
/// 0xRRGGBB.
unsigned map_color(double x);

/// "#440154".
std::string color_text(unsigned rgb);

/// `color` with a share of white (positive) or black (negative), share in [-1, 1].
unsigned shaded(unsigned rgb, double share);

/// "set xtics (...)" for a logarithmic axis from `low` to `high`: 1, 2, 5 per decade when it is short, powers of ten
/// when it is long.
std::string log_tics(char axis, double low, double high);

}  // namespace lamella::app
