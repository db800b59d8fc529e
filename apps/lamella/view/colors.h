#pragma once

#include <string>

namespace lamella::app::view {

/// The table of optics::FilmColorTable as a message (message.h), as the page's shader looks it up: the arrays `thin`
/// (`cosines` rows of `thicknesses` colors) and `thick` (the limit, one color a cosine), linear sRGB beyond [0, 1] too,
/// with `max_thickness_nm` and `reference_index`. The table's header says where its entries lie.
std::string color_message();

}  // namespace lamella::app::view
