#pragma once

#include "lamella/sim/frame.h"

#include <cstddef>

namespace lamella::app::view {

/// A surface of at most `limit` triangles that looks like `surface`: vertices that share a cell of a grid become the one
/// of them that is nearest to their mean, with its own field values; triangles that lose a corner go. Films keep
/// their regions and stay closed up to films thinner than a cell. A surface within the limit comes back as it is.
/// Vertex clustering [RossignacBorrel93], with a representative out of the cluster instead of an optimal point.
sim::Surface thinned(const sim::Surface& surface, std::size_t limit);

/// Every k-th point, with the smallest k that leaves at most `limit`. Balls are points with a radius.
sim::Points thinned(const sim::Points& points, std::size_t limit);

}  // namespace lamella::app::view
