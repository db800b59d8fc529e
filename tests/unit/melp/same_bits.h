#pragma once

// Tests that a run gives the same bits on one and two threads, and when it is continued from a checkpoint.

#include "lamella/core/parallel.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include <utility>
#include <vector>

namespace lamella::melp {

/// @param started  makes the solver, started: called anew for each run; loading overwrites all that matters
/// @param steps    of each run  @param saved  after so many the third one is saved and continued by a fourth
template <class Started>
void expect_same_bits(Started&& started, int steps, int saved) {
    std::vector<test::StateMemory> states;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        auto solver = started();
        advance(*solver, steps);
        states.push_back(state_of(*solver));
    }
    auto first = started();
    advance(*first, saved);
    test::StateMemory memory = state_of(*first);
    auto second = started();
    second->load(memory);
    advance(*second, steps - saved);
    states.push_back(state_of(*second));
    for (const std::size_t k : {1, 2}) {
        EXPECT_EQ(states[0].reals, states[k].reals) << (k == 1 ? "on two threads" : "after a resume");
        EXPECT_EQ(states[0].integers, states[k].integers) << (k == 1 ? "on two threads" : "after a resume");
    }
}

}  // namespace lamella::melp
