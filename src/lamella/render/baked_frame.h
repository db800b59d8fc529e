#pragma once

#include "lamella/sim/frame.h"

namespace lamella::render {

/// A frame as other programs need it to draw: what they cannot work out by themselves becomes fields.
///
/// Films are cut apart along their borders, so that every vertex belongs to one film and has one normal. Vertex fields:
///   normal        unit, towards the region with the larger number [-]
///   thickness_nm  the frame's thickness, that of particles nearby, or an assumed one as in pictures [nm]
///   color         red, green, blue of the film in daylight at normal incidence, 0 to 255, encoded as sRGB; as bright
///   as a
///                 thick film is 45 percent of white [-]
/// and all vertex fields that the frame has (velocity ...). Face fields, regions and points stay as they are; points
/// with a radius get a color too, by `field` (by default their radius; see ColorScale). A scalar thickness_assumed says
/// 1 where no thickness was known.
///
/// @param field  colors films and balls by a field instead; empty: as light does
/// @throws InputError  the frame shows nothing, there is no such field
sim::Frame baked_frame(const sim::Frame& frame, const std::string& field = {});

}  // namespace lamella::render
