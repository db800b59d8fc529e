#pragma once

#include "lamella/solvers/equilibrium/rest_system.h"

#include <vector>

namespace lamella::equilibrium {

/// The lowest eigenvalue of the second variation of the area at fixed volumes, rigid motions left out if nothing is
/// held: K u = lambda M u on G^T u = 0, by subspace iteration with the inverse.
///
/// For a sphere of radius R it is 4 / R^2 (l = 2: (l - 1)(l + 2) / R^2), five times.
/// @param pressure  of each constrained region
/// @returns  [1 / m^2 for a tension of 1]; 0 when there is no motion left
double lowest_eigenvalue(RestSystem& system, const std::vector<double>& pressure);

}  // namespace lamella::equilibrium
