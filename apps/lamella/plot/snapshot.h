#pragma once

#include "lamella/sim/frame.h"

#include "gnuplot.h"
#include "style.h"
#include <string>

namespace lamella::app {

/// What the bubbles of a snapshot are colored by.
enum class ColorBy {
    kRadius,
    kEnergy,        ///< on a logarithmic scale; bubbles without any are gray
    kDisplacement,  ///< the distance moved since the last frame
};

/// A frame of balls at their true size: discs in two dimensions, with the copies that reach in across periodic sides;
/// balls in three, in parallel projection, near ones before far ones, inside the edges of their box.
/// @throws InputError  the frame has no balls or box, or not the field to color by
Panel snapshot_panel(Gnuplot& gnuplot, const sim::Frame& frame, ColorBy color_by);

}  // namespace lamella::app
