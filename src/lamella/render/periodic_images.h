#pragma once

#include "lamella/sim/frame.h"

namespace lamella::render {

/// The bubbles of a periodic box, each whole, repeated `count` times along each periodic axis: frames have each film
/// once, where it happens to lie, so that pieces of bubbles would hang in the air. Films that no bubble has (between
/// region 0 and itself) are left out. Where nothing says which vertices wires hold, none are. `curved_nodes` are
/// dropped. Other frames stay as they are.
/// @param count  1 to 8
sim::Frame periodic_images(sim::Frame frame, int count);

}  // namespace lamella::render
