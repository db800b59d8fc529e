#pragma once

#include "lamella/dist/communicator.h"
#include "lamella/sim/frame.h"

#include <optional>
#include <string_view>
#include <vector>

namespace lamella::measure {

/// Everything that can be measured on a frame, whatever solver made it, in a fixed order.
///
/// Balls (Points with radii), N of them, brackets = mean over the balls:
///   bubbles               N
///   gas_fraction          sum of the balls' volumes / volume of the box (areas in two dimensions); overlaps count
///                         twice
///   mean_radius           <R>
///   mean_square_radius    <R^2>
///   max_radius            largest R
///   mean_contacts         <Z>                               needs the field `contacts`
///   rattlers              fraction with Z < dimension + 1   needs `contacts`
///   velocity_variance     <|v|^2> - |<v>|^2                 needs `velocity`
///   mean_path             <path travelled>                  needs `path_length`
///   mean_square_displacement  <|displacement from start|^2> needs `displacement`
///   gas_fraction_spread   standard deviation of the local gas fraction over a grid of 10 cells per axis
/// Films: film_scalars of film_measures.h.
///
/// A measure whose field (or box) the frame lacks is left out, and so is everything when there are no balls
/// and no films.
///
/// Sums over balls are integers: the same bits on any number of threads and processes.
/// @throws InputError  a field's length does not fit the number of points, or those of film_measures (a damaged frame
///                     file)
std::vector<sim::Scalar> measure_frame(const sim::Frame& frame);

/// The same for balls of which each process has a share. Collective: the frames differ in nothing else.
std::vector<sim::Scalar> measure_frame(const sim::Frame& share, dist::Communicator& processes);

/// The value called `name` among the frame's own scalars or the measures; nothing when there is none.
std::optional<double> find_value(const std::vector<sim::Scalar>& scalars, std::string_view name);

}  // namespace lamella::measure
