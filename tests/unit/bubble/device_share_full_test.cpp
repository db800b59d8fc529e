// One foam on the devices of several processes has the bits of the foam on one CPU, for 512 steps with hundreds of
// deaths.

#include "device_share.h"

namespace lamella::bubble {
namespace {

using namespace test;
const std::vector<int> kNumbers{1, 2, 3, 4};
constexpr int kSteps = 512;

TEST_P(OnDevices, TheFoamHasTheSameBitsIn2DForLong) {
    expect_same_on<2>(kNumbers, coarsening(2, 900, 0.92), kSteps, {}, GetParam());
}

TEST_P(OnDevices, TheFoamHasTheSameBitsIn3DForLong) {
    Options o = coarsening(3, 900, 0.75);
    o.gas.exchange_rate = 5e-3;
    expect_same_on<3>(kNumbers, o, kSteps, {}, GetParam());
}

TEST_P(OnDevices, TheFoamHasTheSameBitsBetweenWallsForLong) {
    Options o = coarsening(3, 600, 0.75);
    o.gas.exchange_rate = 5e-3;
    o.walls = {true, true, false};
    o.wall_drag = 0.3;
    o.flow.kind = FlowKind::kShear;
    o.flow.shear_rate = 0.003;
    expect_same_on<3>(kNumbers, o, kSteps, {}, GetParam());
}

TEST_P(OnDevices, TheFoamHasTheSameBitsAroundAVoidForLong) {
    const std::vector<Ball> balls = discs_beside_a_void(30);
    Options o = given_options(2, 54.0);
    o.gas.exchange_rate = 3.0;
    o.drag = Drag::kNeighborLagged;
    expect_same_on<2>(kNumbers, o, kSteps, balls, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Foam, OnDevices, devices(), device_name);

}  // namespace
}  // namespace lamella::bubble
