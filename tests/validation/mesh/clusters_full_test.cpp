// Five hundred random clusters under torture: the better part of an hour of CPU.

#include <gtest/gtest.h>

#include "../../unit/mesh/popping.h"

namespace lamella::mesh {
namespace {

using namespace test;

/// Ten clusters of 5 to 40 bubbles: no intersection, every label in order, volumes to 1e-9 (all checked on the way).
class ManyClusters : public testing::TestWithParam<int> {};

TEST_P(ManyClusters, ArePoppedToTheLastBubble) {
    for (int k = 0; k < 10; ++k) {
        const int number = 10 * GetParam() + k;
        const int bubbles = 5 + (number * 11) % 36;
        const Torture t = pop_cluster(bubbles, static_cast<std::uint64_t>(1000 + number));
        if (HasFatalFailure() || HasNonfatalFailure()) break;
        EXPECT_LE(t.t1, 10 * bubbles);
        EXPECT_LE(t.worst_stuck, 6);
    }
}

INSTANTIATE_TEST_SUITE_P(OfFiveToForty, ManyClusters, testing::Range(0, 50));

}  // namespace
}  // namespace lamella::mesh
