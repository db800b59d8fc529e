#pragma once

#include "lamella/sim/solver.h"
#include "lamella/solvers/bubble/options.h"
#include "lamella/solvers/bubble/system.h"

#include <vector>

namespace lamella::bubble {

struct Removal {
    std::vector<sim::Event> events;  ///< one per removed bubble, by id; complete on process 0
    double largest_size;             ///< q of the largest bubble of the foam, afterwards
};

/// Removes every bubble at or below the vanishing size; its gas goes to the others in proportion to theirs:
///   q_i <- q_i (1 + a),  a = sum_removed q / sum_surviving q
/// (the thesis prints R_i + R_i a^(1/d), which creates gas: compat.removal). A removed bubble may have passed zero
/// within its last step; its slightly negative q is what was over-paid, and is settled here.
/// Size rates of earlier times are shared out likewise.
/// @throws NumericalError  nothing would be left
template <int D>
Removal remove_vanished(System<D>& system, bool as_printed);

}  // namespace lamella::bubble
