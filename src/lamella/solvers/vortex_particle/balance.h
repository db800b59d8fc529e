#pragma once

// What the particles of a connected film have to sum to.

#include "lamella/solvers/vortex_particle/particles.h"
#include "lamella/solvers/vortex_particle/surface.h"

namespace lamella::vortex_particle {

/// On each component without walls circulation has to sum to zero: what particles of other films have brought is spread
/// evenly over its area, with the opposite sign.
void balance_circulation(const Surface& s, const Bins& bins, Particles& particles);

/// The areas of each component's particles sum to its own. Where they are crowded here and sparse there, as after a
/// burst, they grow and shrink with the film at places that do not stand for it evenly, so that the sum drifts, and with
/// it the liquid that the mesh sees. (In films at rest it does not; there this would make the liquid less right.)
void balance_area(const Surface& s, const Bins& bins, Particles& particles);

}  // namespace lamella::vortex_particle
