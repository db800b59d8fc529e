// One foam on the devices of several processes has the bits of the foam on one CPU, in short;
// device_share_full_test.cpp has it at length.

#include "device_share.h"

namespace lamella::bubble {
namespace {

using namespace test;

constexpr int kSteps = 64;  // that a device takes at once

/// Bubbles vanish from the first steps on.
Options quick(int dimension) {
    Options o = coarsening(dimension, 200, dimension == 2 ? 0.92 : 0.75);
    o.gas.exchange_rate = 0.2;
    o.start.max_iterations = 20;
    return o;
}

TEST_P(OnDevices, TheFoamHasTheSameBitsIn2D) { expect_same_on<2>({1, 2, 3}, quick(2), kSteps, {}, GetParam()); }

TEST_P(OnDevices, TheFoamHasTheSameBitsIn3DBetweenWalls) {
    Options o = quick(3);
    o.walls = {false, true, false};
    o.drag = Drag::kNeighborLagged;
    o.gas.exchange_rate = 1.0;
    expect_same_on<3>({4}, o, 16 * kSteps, {}, GetParam());
}

TEST_P(OnDevices, TheFoamHasTheSameBitsForEveryTolerance) {
    Options o = quick(2);
    o.integrator.norm = ErrorNorm::kRms;
    o.integrator.relative_error = true;
    o.gas.medium_scaling = MediumScaling::kRadius;
    expect_same_on<2>({3}, o, kSteps, {}, GetParam());
}

TEST_P(OnDevices, BubblesMeetThroughSeveralImagesOfASmallBox) {
    ThreadLimit one(1);
    Options o = quick(2);
    o.count = 40;
    o.flow.kind = FlowKind::kUniform;  // around and around, from process to process
    o.flow.velocity = {{0.5, 0.2, 0.0}};
    const Outcome alone = run_shared<2>(o, kSteps, 1);
    expect_same(run_shared<2>(o, kSteps, 2, {}, GetParam()), alone);
    expect_same(run_shared<2>(o, kSteps, 3, {}, GetParam()), alone);
}

TEST_P(OnDevices, AnyNumberOfProcessesContinuesTheFoamOfTwo) {
    ThreadLimit one(1);
    const Options o = quick(2);
    Outcome half;
    Outcome whole;
    as_processes(2, [&](const Processes& all) {
        auto solver = make_share<2>(o, all, {}, GetParam());
        solver->start({});
        take_steps(*solver, kSteps);
        look(*solver, *all, half);
        take_steps(*solver, kSteps);
        look(*solver, *all, whole);
    });
    const auto resume = [&](int processes, Device device) {
        Outcome resumed;
        as_processes(processes, [&](const Processes& all) {
            auto solver = make_share<2>(o, all, {}, device);
            SharedMemory memory(*all, half.state);
            solver->load(memory);
            take_steps(*solver, kSteps);
            look(*solver, *all, resumed);
        });
        EXPECT_EQ(resumed.state, whole.state) << processes << " processes";
    };
    resume(1, GetParam());
    resume(3, GetParam());
    resume(2, Device::kCpu);
}

TEST_P(OnDevices, ASlowProcessGetsFewerBubblesAndTheSameBits) {
    ThreadLimit one(1);
    const Options o = quick(2);
    const Outcome alone = run_shared<2>(o, 2 * kSteps, 1);
    Outcome shared;
    std::vector<std::size_t> own(2);
    lamella::test::ProcessTeam team(2);
    team.set_pace({2.5, 4.0});
    team.run([&](const Processes& all) {
        auto solver = make_share<2>(o, all, {}, GetParam());
        solver->start({});
        take_steps(*solver, 2 * kSteps);
        look(*solver, *all, shared);
        own[static_cast<std::size_t>(all->rank())] = solver->system().foam.slots;
    });
    EXPECT_EQ(shared.state, alone.state);
    EXPECT_LT(static_cast<double>(own[1]), 0.8 * static_cast<double>(own[0]));
}

INSTANTIATE_TEST_SUITE_P(Foam, OnDevices, devices(), device_name);

}  // namespace
}  // namespace lamella::bubble
