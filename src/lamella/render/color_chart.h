#pragma once

#include "lamella/optics/film_colors.h"
#include "lamella/render/canvas.h"

#include <string>
#include <vector>

namespace lamella::render {

/// The colors of soap films over thickness (0 to 1500 nm) and angle of incidence, as one looks at them: a film as
/// bright as a thick one is shown at 45 percent of white, so that the brightest fringes just fit.
Canvas color_chart(const optics::FilmLight& film, std::size_t width, std::size_t height);

/// One line of the chart in words.
struct ChartRow {
    double thickness = 0.0;    ///< [m]
    double reflectance = 0.0;  ///< of normally incident white light, as the eye weighs it [-]
    std::array<std::uint8_t, 3> screen{};
    std::string name;  ///< "straw yellow" is "yellow": optics::color_name
};

/// Normal incidence, every `step` [m] up to 1500 nm.
std::vector<ChartRow> color_rows(const optics::FilmLight& film, double step);

}  // namespace lamella::render
