#include "lamella/solvers/equilibrium/crossing_memory.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include "../sim/state_memory.h"

namespace lamella::equilibrium {
namespace {

using mesh::RegionId;

mesh::TopologyEvent parting(int a, int b, Vec3 place) {
    return {mesh::TopologyEvent::Kind::kT1, place, static_cast<RegionId>(a), static_cast<RegionId>(b)};
}

TEST(CrossingMemory, HoldsWhatPartsAtTheSamePlaceForTheFourthTime) {
    CrossingMemory memory;
    EXPECT_FALSE(memory.note_parting(parting(1, 2, {0, 0, 0}), 0.1));
    EXPECT_FALSE(memory.note_parting(parting(2, 1, {0.1, 0, 0}), 0.1));  // the other way around, a little aside
    EXPECT_FALSE(memory.note_parting(parting(1, 3, {0, 0, 0}), 0.1));    // others
    EXPECT_FALSE(memory.note_parting(parting(1, 2, {5, 0, 0}), 0.1));    // elsewhere
    EXPECT_FALSE(memory.note_parting(parting(1, 2, {0.2, 0, 0}), 0.1));  // slides along
    EXPECT_TRUE(memory.held().empty());
    EXPECT_TRUE(memory.note_parting(parting(1, 2, {0.3, 0, 0}), 0.1));
    ASSERT_EQ(memory.held().size(), 1u);
    EXPECT_EQ(memory.held()[0].a, static_cast<RegionId>(1));
    EXPECT_EQ(memory.held()[0].b, static_cast<RegionId>(2));
    EXPECT_EQ(memory.held()[0].position, (Vec3{0.3, 0, 0}));
}

TEST(CrossingMemory, GoesOnFromACheckpoint) {
    CrossingMemory memory;
    for (int k = 0; k < 4; ++k) memory.note_parting(parting(1, 2, {1, 2, 3}), 0.1);
    for (int k = 0; k < 3; ++k) memory.note_parting(parting(4, 2, {0, 0, 0}), 0.1);
    test::StateMemory state;
    memory.save(state);
    CrossingMemory again(state);
    ASSERT_EQ(again.held().size(), 1u);
    EXPECT_EQ(again.held()[0].position, (Vec3{1, 2, 3}));
    EXPECT_TRUE(again.note_parting(parting(2, 4, {0, 0, 0}), 0.1));
}

TEST(CrossingMemory, RefusesADamagedCheckpoint) {
    test::StateMemory state;
    CrossingMemory().save(state);
    state.integers["crossings/count"] = {-1};
    EXPECT_THROW(CrossingMemory{state}, InputError);
    state.integers["crossings/count"] = {1};
    EXPECT_THROW(CrossingMemory{state}, InputError);
    state.reals["crossings/seen"] = {-7.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    EXPECT_THROW(CrossingMemory{state}, InputError);
}

}  // namespace
}  // namespace lamella::equilibrium
