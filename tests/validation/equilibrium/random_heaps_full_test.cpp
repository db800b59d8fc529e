// How many random heaps it takes to find the lightest cluster known of N bubbles.

#include <gtest/gtest.h>

#include "rest.h"
#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lamella::equilibrium {
namespace {

TEST(RandomHeaps, LeadToTheLightestClusterKnownInAFewStarts) {
    const std::vector<std::pair<int, double>> lightest{{3, 13.1281682444334}, {4, 16.8965576436161}, {5, 20.632224444053},
                                                       {6, 24.228995845132},  {8, 31.4325184082},    {10, 38.454847587224},
                                                       {13, 48.386854577245}};
    constexpr int kStarts = 8;
    for (const auto& [count, area] : lightest) {
        int reached = 0, first = 0, at_rest = 0;
        double best = std::numeric_limits<double>::infinity();
        for (int seed = 1; seed <= kStarts; ++seed) {
            const Rest rest = rest_of("cluster-5-small", {"foam.count=" + std::to_string(count), "seed=" + std::to_string(seed),
                                                          "equilibrium.eigenvalue=false"});
            best = std::min(best, rest.answer.area);
            at_rest += rest.answer.stable() ? 1 : 0;
            if (rest.answer.area > area * (1.0 + 3e-6)) continue;
            ++reached;
            if (first == 0) first = seed;
        }
        std::printf("N = %2d: %d of %d starts reach %.9f, the first is number %d, best %+.1e; %d are stable\n", count, reached,
                    kStarts, area, first, best / area - 1.0, at_rest);
        EXPECT_GT(reached, 0) << count;
        EXPECT_GT(best, area * (1.0 - 3e-6)) << count << ": lighter than any known; look at it";
    }
}

}  // namespace
}  // namespace lamella::equilibrium
