#pragma once

#include "lamella/dist/communicator.h"
#include "lamella/sim/frame.h"

#include <vector>

namespace lamella::measure {

/// Cells per axis of the grid that [Lankinen20, 4.2.1] uses.
inline constexpr int kGasFractionCells = 10;

/// pi R^2 in two dimensions, 4/3 pi R^3 in three.
double ball_volume(double radius, int dimension);

/// Product of the edge lengths (two of them in two dimensions).
double box_volume(const sim::Box& box);

/// Local gas fraction: the volume of the balls that lies in each cell of a regular grid, over the cell's volume.
/// Overlaps count twice, as in the global gas fraction, whose mean over the cells this is.
///
/// The share of a disc in a cell is exact; that of a ball is integrated over 8 Gauss points per slab and normalized
/// so that no volume is lost. Across a periodic side the rest counts on the other side; what a ball pushes through a
/// wall counts in the cell at the wall.
///
/// @param cells  per axis, at least 1
/// @returns      cells^dimension values [-], x fastest
/// @throws InputError  the balls lack radii, a value is not finite, the box has no volume, or a ball is larger than it
std::vector<double> local_gas_fraction(const sim::Points& balls, const sim::Box& box, int cells);

/// The same for balls of which each process has a share; all get all cells. Collective.
std::vector<double> local_gas_fraction(const sim::Points& share,
                                       const sim::Box& box,
                                       int cells,
                                       dist::Communicator& processes);

}  // namespace lamella::measure
