// Films shorter at rest than the mesh can show used to open and close without end (315 T1 and no rest with this seed).

#include "popped_clusters.h"

namespace lamella::equilibrium {
namespace {

TEST(PoppedCluster, ComesToRestAfterEveryBurst) {
    const Popped popped = pop_to_the_last(20, 5);
    EXPECT_EQ(popped.pops, 19);
    EXPECT_GE(popped.bubbles_left, 1u);
    EXPECT_LE(popped.t1, 10 * popped.pops);
}

}  // namespace
}  // namespace lamella::equilibrium
