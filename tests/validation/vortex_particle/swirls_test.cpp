// Vortices in a flat film that keeps its thickness.

#include "swirls.h"

#include <gtest/gtest.h>

namespace lamella::vortex_particle {
namespace {

/// The critical distance of two Taylor vortices lies between these two [method sheet 12.2].
TEST(TaylorVortices, PartFrom081AndMergeFrom060) {
    const PairRun apart = run_pair(0.81, 64, 6.0), together = run_pair(0.60, 64, 6.0);
    EXPECT_GT(apart.end, 1.5);
    EXPECT_LT(together.end, 0.3);
    EXPECT_LT(apart.energy_error, 0.01);
    EXPECT_LT(together.energy_error, 0.01);
}

/// The first swap of vortices with cores of a fifth of their distance, against that of point vortices in the same box.
TEST(Leapfrog, SwapsPlacesForTheFirstTimeWhenPointVorticesDo) {
    const std::vector<double> exact = point_swaps(2.5);
    ASSERT_EQ(exact.size(), 1u);
    auto solver = leapfrog(0.08, 1.0 / 32, 0.01);
    const std::vector<double> found = swaps(*solver, 2.5);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0] / exact[0], 1.0, 0.05);
}

}  // namespace
}  // namespace lamella::vortex_particle
