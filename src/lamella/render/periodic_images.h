#pragma once

#include "lamella/sim/frame.h"

namespace lamella::render {

/// Films in a periodic box, repeated `count` times along each periodic axis: a box of its own shows pieces of cells
/// that hang in the air. Pieces that still do are left out. Where nothing says which vertices wires hold, none are.
/// Other frames stay as they are.
/// @param count  1 to 8
sim::Frame periodic_images(sim::Frame frame, int count);

}  // namespace lamella::render
