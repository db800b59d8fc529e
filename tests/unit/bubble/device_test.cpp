// The program for the GPU, run by its CPU twin with the threads of every loop in shuffled order, against the solver on
// the CPU: bit for bit. On a machine with a GPU the GPU is held against the same states.

#include "lamella/core/cuda.h"
#include "lamella/solvers/bubble/detail/device_runner.h"

#include <gtest/gtest.h>

#include "foams.h"

using namespace lamella;
using namespace lamella::bubble;
using namespace lamella::bubble::test;

namespace {

template <int D>
std::unique_ptr<BubbleSolver<D>> start_on(lamella::Device device, const Options& options) {
    sim::SolverInput input;
    input.seed = 4;
    input.device = device;
    auto solver = std::make_unique<BubbleSolver<D>>(options, input);
    solver->start({});
    return solver;
}

/// Continues a state on a device.
template <int D>
std::unique_ptr<BubbleSolver<D>> continue_on(lamella::Device device, const Options& options, Memory state) {
    sim::SolverInput input;
    input.seed = 4;
    input.device = device;
    auto solver = std::make_unique<BubbleSolver<D>>(options, input);
    solver->load(state);
    return solver;
}

Options small(int dimension, int count = 300) {
    Options o = coarsening(dimension, count, dimension == 2 ? 0.95 : 0.75);
    o.start.max_iterations = 40;
    return o;
}

/// Both reach `time` in the same steps, with the same bits, past some removals.
template <int D>
void expect_the_same_run(lamella::Device device, const Options& options, double time) {
    const auto cpu = start_on<D>(lamella::Device::kCpu, options);
    const auto other = continue_on<D>(device, options, saved(*cpu));
    for (const double until : {0.1 * time, time}) {
        run_to(*cpu, until);
        run_to(*other, until);
        EXPECT_EQ(cpu->step(), other->step());
        EXPECT_TRUE(saved(*cpu) == saved(*other)) << "at time " << until;
    }
    const auto events = cpu->take_events();
    const auto other_events = other->take_events();
    ASSERT_EQ(events.size(), other_events.size());
    for (std::size_t n = 0; n < events.size(); ++n) {
        EXPECT_EQ(events[n].detail, other_events[n].detail);
        EXPECT_EQ(events[n].time, other_events[n].time);
        EXPECT_EQ(events[n].position, other_events[n].position);
    }
    EXPECT_GT(options.gas.exchange_rate == 0.0 ? 1U : events.size(), 0U);
}

class OnDevice : public testing::TestWithParam<lamella::Device> {
protected:
    void SetUp() override {
        const std::string fault = cuda_fault();
        if (GetParam() == lamella::Device::kCuda && !fault.empty()) GTEST_SKIP() << fault;
    }
};

}  // namespace

TEST_P(OnDevice, TakesTheStepsOfTheCpuInTwoDimensions) { expect_the_same_run<2>(GetParam(), small(2), 2.0); }

TEST_P(OnDevice, TakesTheStepsOfTheCpuInThreeDimensions) { expect_the_same_run<3>(GetParam(), small(3, 343), 3.0); }

TEST_P(OnDevice, KnowsWallsAndFlow) {
    Options o = small(2);
    o.walls = {false, true, false};
    o.wall_blocks_gas = true;
    o.flow.kind = FlowKind::kShear;
    o.flow.shear_rate = 0.01;
    expect_the_same_run<2>(GetParam(), o, 1.5);
    o.flow.kind = FlowKind::kRegion;
    o.flow.edge_width = 1.0;
    o.gas.medium_scaling = MediumScaling::kRadius;
    expect_the_same_run<2>(GetParam(), o, 1.5);
}

TEST_P(OnDevice, KnowsTheLaggedDragOfNeighbors) {
    Options o = small(2);
    o.drag = Drag::kNeighborLagged;
    o.flow.kind = FlowKind::kRegion;
    o.walls = {true, false, false};
    expect_the_same_run<2>(GetParam(), o, 1.5);
}

TEST_P(OnDevice, KnowsEveryToleranceAndScaling) {
    Options o = small(3, 343);
    o.gas.medium_scaling = MediumScaling::kLsw;
    o.integrator.norm = ErrorNorm::kRms;
    o.integrator.relative_error = true;
    expect_the_same_run<3>(GetParam(), o, 3.0);
    o.gas.exchange_rate = 0.0;
    o.time_unit = TimeUnit::kMechanical;
    expect_the_same_run<3>(GetParam(), o, 20.0);
}

TEST_P(OnDevice, MeetsBubblesThroughSeveralImagesOfASmallBox) {
    Options o = small(2, 60);
    o.end_count = 20;
    expect_the_same_run<2>(GetParam(), o, 5.0);
    o.flow.kind = FlowKind::kUniform;  // around and around
    o.flow.velocity = {{0.5, 0.2, 0.0}};
    expect_the_same_run<2>(GetParam(), o, 5.0);
}

TEST_P(OnDevice, EndsWhereTheCpuEnds) {
    Options o = small(2, 200);
    o.end_count = 100;
    const auto cpu = start_on<2>(lamella::Device::kCpu, o);
    const auto other = start_on<2>(GetParam(), o);
    run_to(*cpu, 1e9);
    run_to(*other, 1e9);
    EXPECT_EQ(cpu->stop_reason(), other->stop_reason());
    EXPECT_TRUE(saved(*cpu) == saved(*other));
}

TEST_P(OnDevice, ExchangesCheckpointsWithTheCpu) {
    const Options o = small(2);
    const auto straight = start_on<2>(lamella::Device::kCpu, o);
    const auto there = start_on<2>(GetParam(), o);
    run_to(*straight, 0.4);
    run_to(*there, 0.4);
    const auto back = continue_on<2>(lamella::Device::kCpu, o, saved(*there));
    run_to(*straight, 0.8);
    run_to(*back, 0.8);
    const auto again = continue_on<2>(GetParam(), o, saved(*back));
    run_to(*straight, 1.2);
    run_to(*again, 1.2);
    EXPECT_TRUE(saved(*straight) == saved(*again));
    const auto frame = again->frame();
    EXPECT_EQ(frame.points.position.size(), straight->frame().points.position.size());
    EXPECT_EQ(scalar(*again, "energy"), scalar(*straight, "energy"));
}

TEST_P(OnDevice, CountsDisplacementsFromTheLastFrame) {
    const Options o = small(2);
    const auto cpu = start_on<2>(lamella::Device::kCpu, o);
    const auto other = start_on<2>(GetParam(), o);
    for (auto* solver : {cpu.get(), other.get()}) {
        run_to(*solver, 0.2);
        static_cast<void>(solver->frame());
        solver->mark_frame();
        run_to(*solver, 0.4);
    }
    EXPECT_TRUE(saved(*cpu) == saved(*other));
}

INSTANTIATE_TEST_SUITE_P(Twin, OnDevice, testing::Values(lamella::Device::kCudaTwin));
INSTANTIATE_TEST_SUITE_P(Gpu, OnDevice, testing::Values(lamella::Device::kCuda));

TEST(DeviceTwin, HasTheSameBitsInAnyOrderOfItsThreads) {
    const Options o = small(2, 1000);
    const auto cpu = start_on<2>(lamella::Device::kCpu, o);
    const System<2>& s = cpu->system();
    std::vector<std::vector<double>> sizes;
    for (const auto order :
         {HostMachine::Order::kForward, HostMachine::Order::kBackward, HostMachine::Order::kShuffled}) {
        const auto runner = bubble::detail::make_twin_runner<2>(o, order);
        runner->upload(s.foam, s.model, {}, {.next_step = 1e-3, .stiffness = 0.0, .rates_current = false});
        runner->advance(0.5, 1'000'000);
        EXPECT_EQ(runner->control().waiting, bubble::detail::Waiting::kLimit);
        Foam<2> foam;
        runner->download(foam);
        std::vector<double> by_id(o.count + 100, 0.0);
        for (std::size_t i = 0; i < foam.slots; ++i) by_id[static_cast<std::size_t>(foam.id[i])] = foam.size[i];
        sizes.push_back(by_id);
    }
    EXPECT_EQ(sizes[0], sizes[1]);
    EXPECT_EQ(sizes[0], sizes[2]);
}

TEST(DeviceOptions, ThatDoNotRunThereAreRefusedByName) {
    sim::SolverInput input;
    input.device = lamella::Device::kCuda;
    const auto message = [&](const Options& o) {
        try {
            BubbleSolver<2> solver(o, input);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    Options o;
    o.drag = Drag::kPairwise;
    EXPECT_EQ(message(o), "bubble.drag = \"pairwise\" does not run on a GPU; use --device cpu");
    o = {};
    o.integrator.method = Method::kAbm2;
    EXPECT_EQ(message(o), "bubble.integrator.method = \"abm2\" does not run on a GPU; use --device cpu");
}
