#pragma once

#include <vector>

#include "lamella/sim/solver.h"
#include "lamella/solvers/bubble/options.h"
#include "lamella/solvers/bubble/system.h"

namespace lamella::bubble {

/// Removes every bubble at or below the vanishing size; its gas goes to the others in proportion to theirs:
///   q_i <- q_i (1 + a),  a = sum_removed q / sum_surviving q
/// (the thesis prints R_i + R_i a^(1/d), which creates gas: compat.removal). A removed bubble may have passed zero
/// within its last step; its slightly negative q is what was over-paid, and is settled here.
/// Size rates of earlier times are shared out likewise.
/// @returns  an event per removed bubble, by id; complete on process 0
/// @throws NumericalError  nothing would be left
template <int D>
std::vector<sim::Event> remove_vanished(System<D>& system, bool as_printed);

}  // namespace lamella::bubble
