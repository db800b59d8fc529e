// Fifty random clusters under torture.

#include <gtest/gtest.h>

#include "../../unit/mesh/popping.h"

namespace lamella::mesh {
namespace {

using namespace test;

/// Ten clusters of 5 to 40 bubbles: no intersection, every label in order, volumes to 1e-9 (all checked on the way).
class Clusters : public testing::TestWithParam<int> {};

TEST_P(Clusters, ArePoppedToTheLastBubble) {
    for (int k = 0; k < 10; ++k) {
        const int number = 10 * GetParam() + k;
        const int bubbles = 5 + (number * 11) % 36;
        const Torture t = pop_cluster(bubbles, static_cast<std::uint64_t>(100 + number));
        if (HasFatalFailure() || HasNonfatalFailure()) break;
        EXPECT_LE(t.t1, 10 * bubbles);
        EXPECT_LE(t.worst_stuck, 6);
    }
}

INSTANTIATE_TEST_SUITE_P(OfFiveToForty, Clusters, testing::Range(0, 5));

}  // namespace
}  // namespace lamella::mesh
