#pragma once

#include "lamella/spatial/vortex_sum.h"

namespace lamella::vortex_sheet {

/// The response of a flat sheet to a wave of wave number k, over that without smoothing; x = k delta [method sheet 6.2, 6.3]:
///   plummer e^-x;  k2 e^-x (1 + x);  k3 e^-x (1 + x + x^2 / 2)
double kernel_factor(spatial::VortexKernel kernel, double x);

/// Longest stable step of the explicit integrators, 2 / omega of the fastest capillary wave that the mesh can hold [s]:
///   omega^2 = sigma / rho * k^3 * kernel_factor(k delta),   k <= pi / h   [method sheet 8]
///
/// @param smoothing_length  delta / h [-]
/// @param edge_length       h [m]
/// @param surface_tension   of one interface [N/m]
/// @param density           of the air on both sides [kg/m^3]
double capillary_step_limit(spatial::VortexKernel kernel,
                            double smoothing_length,
                            double edge_length,
                            double surface_tension,
                            double density);

}  // namespace lamella::vortex_sheet
