// Twenty-four clusters of 8 to 40 bubbles, burst to the last, at rest after every burst.

#include "popped_clusters.h"

#include <cstdio>

namespace lamella::equilibrium {
namespace {

class PoppedClusters : public testing::TestWithParam<int> {};

TEST_P(PoppedClusters, ComeToRestAfterEveryBurst) {
    const int seed = GetParam();
    const int bubbles = seed <= 12 ? 20 : 8 + (seed * 7) % 33;
    const Popped popped = pop_to_the_last(bubbles, seed);
    std::printf("%d bubbles, seed %d: %d T1 in %d bursts\n", bubbles, seed, popped.t1, popped.pops);
    EXPECT_EQ(popped.pops, bubbles - 1);
    EXPECT_GE(popped.bubbles_left, 1u);
    EXPECT_LE(popped.t1, 10 * popped.pops);
}

INSTANTIATE_TEST_SUITE_P(OfEightToForty, PoppedClusters, testing::Range(1, 25));

}  // namespace
}  // namespace lamella::equilibrium
