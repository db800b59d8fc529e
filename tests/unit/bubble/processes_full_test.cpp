// One foam on several processes has the bits of the foam on one, for 500 steps with hundreds of deaths.

#include "processes.h"

namespace lamella::bubble {
namespace {

using namespace test;
const std::vector<int> kNumbers{2, 3, 4, 8};

TEST(Processes, GiveTheSameBitsIn2DForLong) { expect_same_on<2>(kNumbers, coarsening(2, 900, 0.92), 500); }

TEST(Processes, GiveTheSameBitsIn3DForLong) {
    Options o = coarsening(3, 900, 0.75);
    o.gas.exchange_rate = 5e-3;
    expect_same_on<3>(kNumbers, o, 500);
}

TEST(Processes, GiveTheSameBitsBetweenWallsForLong) {
    Options o = coarsening(3, 600, 0.75);
    o.gas.exchange_rate = 5e-3;
    o.walls = {true, true, false};
    o.wall_drag = 0.3;
    o.flow.kind = FlowKind::kShear;
    o.flow.shear_rate = 0.003;
    o.drag = Drag::kNeighborLagged;
    expect_same_on<3>(kNumbers, o, 500);
}

TEST(Processes, GiveTheSameBitsAroundAVoidForLong) {
    const std::vector<Ball> balls = discs_beside_a_void(30);
    Options o = given_options(2, 54.0);
    o.gas.exchange_rate = 0.3;
    o.integrator.method = Method::kAbm2;
    expect_same_on<2>(kNumbers, o, 500, balls);
}

}  // namespace
}  // namespace lamella::bubble
