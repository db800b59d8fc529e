#pragma once

#include "lamella/sim/frame.h"

#include <cstddef>
#include <string>

namespace lamella::app::view {

/// What a frame is thinned out to before it travels: more than this no graphics card of a laptop shows fluently.
struct DetailLimits {
    std::size_t triangles = 300'000;
    std::size_t points = 1'000'000;
    std::size_t smooth = 30'000;  ///< triangles that coarser films may be cut into to look smooth
};

/// A frame as the page draws it (message.h): films cut apart along their borders and smooth (smooth_films.h), borders
/// and wires as segments, points, solids, every field of one, three or nine components in single precision.
/// @throws InputError  the frame contradicts itself
std::string frame_message(const sim::Frame& frame, const DetailLimits& limits = {});

/// Volume, pressure, area and neighbors of every bubble, as JSON. What is not known is null.
/// @throws InputError  the frame contradicts itself
std::string regions_text(const sim::Frame& frame);

}  // namespace lamella::app::view
