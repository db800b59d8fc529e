#pragma once

#include <cstdint>
#include <vector>

#include "lamella/dist/communicator.h"
#include "lamella/solvers/bubble/domain.h"
#include "lamella/solvers/bubble/foam.h"
#include "lamella/solvers/bubble/model.h"
#include "lamella/solvers/bubble/options.h"

namespace lamella::bubble {

/// One bubble of a file packing.
struct GivenBubble {
    Vec3 position;
    double radius = 0.0;
};

/// Fills the foam with the first bubbles, box included, not yet scaled to a gas fraction, ids 0 to N - 1. Of several
/// processes each makes its share of the ids, wherever in the box they are.
///
/// Grid [Lankinen20, 3.2.1; method sheet, section 5]: spacing 2 <R_in>, each axis with enough points that the box has
/// the wanted shape and at least `count` bubbles; each point moved by <R_in> U in a random direction. Radii
/// |N(mean, std)|, those at or below the vanishing radius raised by it.
/// @param given  the bubbles of packing = "file"
template <int D>
void pack(const Options& options,
          std::uint64_t seed,
          const std::vector<GivenBubble>& given,
          const dist::Communicator& processes,
          Foam<D>& foam);

/// Two bubbles at the very same point have no direction to part in: every bubble that stands on another is moved by
/// a millionth of the mean radius. Both must be on the same process.
template <int D>
void part_coincident(const Options& options, std::uint64_t seed, Foam<D>& foam);

/// The box is given with a file packing: it is not scaled.
bool has_file_box(const Options& options);

/// Scales box and positions so that the bubbles fill `gas_fraction` of the box.
template <int D>
void scale_to_gas_fraction(const Options& options, double gas_fraction, const Domain& domain, Foam<D>& foam);

}  // namespace lamella::bubble
