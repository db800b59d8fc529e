#pragma once

#include "lamella/mesh/tracker.h"

namespace lamella::mesh {

/// Moves the films by `displacement` [m] in as many calls of Tracker::move as its longest step asks for, at most
/// `most_moves`; what is farther is cut, the same share for all vertices.
/// @returns how many vertices did not go all the way in at least one of the moves
std::size_t staged_move(Tracker& tracker, const IdVector<VertexId, Vec3>& displacement, int most_moves = 4);

}  // namespace lamella::mesh
