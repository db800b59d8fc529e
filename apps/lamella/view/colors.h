#pragma once

#include <string>

namespace lamella::app::view {

/// What soap films reflect under white light (D65), as a message (message.h) with one array `colors`: rows of cosines of
/// the angle of incidence from 0 to 1, each with thicknesses from 0 to `largest_thickness_nm` in equal steps; linear
/// sRGB, not limited to [0, 1], 1 being the white of the light. `thick` has one row of the limit of thick films.
std::string color_message();

}  // namespace lamella::app::view
