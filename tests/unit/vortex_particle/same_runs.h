#pragma once

// Runs of vortex_particle that have to end alike.

#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include <gtest/gtest.h>

namespace lamella::vortex_particle {

inline void advance(VortexParticleSolver& solver, double until, std::int64_t stop_after = 1'000'000) {
    for (std::int64_t k = 0; k < stop_after && solver.time() < until; ++k) solver.advance(until);
}

inline void expect_equal(const VortexParticleSolver& a, const VortexParticleSolver& b) {
    EXPECT_EQ(a.time(), b.time());
    EXPECT_EQ(a.particles().triangle, b.particles().triangle);
    EXPECT_EQ(a.particles().place, b.particles().place);
    EXPECT_EQ(a.particles().circulation, b.particles().circulation);
    EXPECT_EQ(a.particles().area, b.particles().area);
    EXPECT_EQ(a.particles().velocity, b.particles().velocity);
    for (std::size_t k = 0; k < a.bodies().size(); ++k) {
        EXPECT_EQ(a.bodies()[k].center, b.bodies()[k].center);
        EXPECT_EQ(a.bodies()[k].velocity, b.bodies()[k].velocity);
        EXPECT_EQ(a.bodies()[k].force, b.bodies()[k].force);
        EXPECT_EQ(a.bodies()[k].in_film, b.bodies()[k].in_film);
    }
}

}  // namespace lamella::vortex_particle
