#pragma once

#include "lamella/solvers/vortex_particle/particles.h"
#include "lamella/solvers/vortex_particle/surface.h"

namespace lamella::vortex_particle {

/// The two leaves of a film between bubbles share what they have: per triangle the one with the more surfactant per
/// area gives the share 1 - exp(-exposure (1 - Gamma_other / Gamma)) of its liquid and surfactant to the particles of
/// the other. (The paper lets particles change over at random and with a chance per step [Tao24, eq. 23]; circulation
/// stays, as the sum over each leaf has to be zero.)
/// @param exposure  rate times time [-]
void exchange_between_leaves(const Surface& s, const Bins& bins, double exposure, Particles& particles);

}  // namespace lamella::vortex_particle
