// One foam on several processes has the bits of the foam on one, in short; processes_full_test.cpp has it at length.

#include "processes.h"

#include "lamella/solvers/bubble/process_plan.h"

namespace lamella::bubble {
namespace {

using namespace test;

/// Bubbles vanish from the first steps on.
Options quick(int dimension) {
    Options o = coarsening(dimension, 200, dimension == 2 ? 0.92 : 0.75);
    o.gas.exchange_rate = 0.2;
    o.start.max_iterations = 20;
    return o;
}

TEST(Processes, GiveTheSameBitsIn2D) { expect_same_on<2>({2, 3}, quick(2), 40); }

TEST(Processes, GiveTheSameBitsIn3D) {
    Options o = quick(3);
    o.walls = {false, true, false};
    o.drag = Drag::kPairwise;
    o.gas.exchange_rate = 1.0;
    expect_same_on<3>({4}, o, 40);
}

TEST(Processes, ContinueEachOthersStates) {
    ThreadLimit one(1);
    Options o = quick(2);
    o.integrator.method = Method::kAbm2;
    Outcome half;
    Outcome whole;
    as_processes(2, [&](const Processes& all) {
        auto solver = make_share<2>(o, all);
        solver->start({});
        for (int step = 0; step < 20; ++step) solver->advance(1e9);
        look(*solver, *all, half);
        for (int step = 0; step < 20; ++step) solver->advance(1e9);
        look(*solver, *all, whole);
    });
    for (const int processes : {1, 3}) {
        Outcome resumed;
        as_processes(processes, [&](const Processes& all) {
            auto solver = make_share<2>(o, all);
            SharedMemory memory(*all, half.state);
            solver->load(memory);
            for (int step = 0; step < 20; ++step) solver->advance(1e9);
            look(*solver, *all, resumed);
        });
        EXPECT_EQ(resumed.state, whole.state) << processes << " processes";
    }
}

TEST(Processes, ThatAreSlowGetFewerBubblesAndTheSameBits) {
    ThreadLimit one(1);
    const Options o = quick(2);
    const Outcome alone = run_shared<2>(o, 60, 1);
    Outcome shared;
    std::vector<std::size_t> own(2);
    lamella::test::ProcessTeam team(2);
    team.set_pace({1.0, 1.5});
    team.run([&](const Processes& all) {
        auto solver = make_share<2>(o, all);
        solver->start({});
        for (int step = 0; step < 60; ++step) solver->advance(1e9);
        look(*solver, *all, shared);
        const Foam<2>& foam = solver->system().foam;
        for (std::size_t i = 0; i < foam.slots; ++i)
            own[static_cast<std::size_t>(all->rank())] += foam.alive(i) ? 1 : 0;
    });
    EXPECT_EQ(shared.state, alone.state);
    EXPECT_LT(static_cast<double>(own[1]), 0.75 * static_cast<double>(own[0]));
    EXPECT_GT(static_cast<double>(own[1]), 0.4 * static_cast<double>(own[0]));
}

/// The plan's copies per own bubble over those that are there, on average over the processes.
template <int D>
double halo_share_over_found(const Options& options, int processes) {
    double found = 0.0;
    as_processes(processes, [&](const Processes& all) {
        auto solver = make_share<D>(options, all);
        solver->start({});
        const System<D>& system = solver->system();
        std::int64_t copies = static_cast<std::int64_t>(system.domain().copies());
        copies = dist::sum(*all, copies);
        if (all->rank() == 0) found = static_cast<double>(copies) / static_cast<double>(system.foam.live);
    });
    return halo_share<D>(options, processes) / found;
}

TEST(Processes, HaveAboutAsManyCopiesAsPlanned) {
    Options o = coarsening(2, 3000, 0.95);
    o.start.max_iterations = 20;
    for (const int processes : {2, 4, 8}) EXPECT_NEAR(halo_share_over_found<2>(o, processes), 1.0, 0.2) << processes;
    o.box_shape = {{4.0, 1.0, 1.0}};
    EXPECT_NEAR(halo_share_over_found<2>(o, 4), 1.0, 0.2) << "cut along one axis only";
    o = coarsening(3, 4000, 0.8);
    o.start.max_iterations = 20;
    for (const int processes : {2, 8}) EXPECT_NEAR(halo_share_over_found<3>(o, processes), 1.0, 0.25) << processes;
}

TEST(Processes, RefuseAStateTogether) {
    Outcome half;
    as_processes(2, [&](const Processes& all) {
        auto solver = make_share<2>(quick(2), all);
        solver->start({});
        look(*solver, *all, half);
    });
    std::get<std::vector<double>>(half.state.entries["foam/position_x"])[7] = std::nan("");
    as_processes(3, [&](const Processes& all) {
        auto solver = make_share<2>(quick(2), all);
        SharedMemory memory(*all, half.state);
        EXPECT_THROW(solver->load(memory), InputError);
    });
}

TEST(Processes, CarryIdsBeyond32Bits) {
    ThreadLimit one(1);
    const Options o = quick(2);
    Outcome start;
    as_processes(1, [&](const Processes& all) {
        auto solver = make_share<2>(o, all);
        solver->start({});
        look(*solver, *all, start);
    });
    constexpr std::int64_t kFar = std::int64_t{1} << 40;
    auto& ids = std::get<std::vector<std::int64_t>>(start.state.entries["foam/id"]);
    for (std::size_t i = 0; i < ids.size(); ++i)
        ids[i] = kFar / static_cast<std::int64_t>(ids.size()) * static_cast<std::int64_t>(i);
    start.state.entries["start_count"] = std::vector<std::int64_t>{kFar};
    std::vector<Outcome> after(2);
    for (const int processes : {1, 3})
        as_processes(processes, [&](const Processes& all) {
            auto solver = make_share<2>(o, all);
            SharedMemory memory(*all, start.state);
            solver->load(memory);
            for (int step = 0; step < 20; ++step) solver->advance(1e9);
            look(*solver, *all, after[processes == 1 ? 0 : 1]);
        });
    EXPECT_EQ(after[0].state, after[1].state);
    EXPECT_GT(std::get<std::vector<std::int64_t>>(after[0].state.entries["foam/id"]).back(), kFar / 2);
}

}  // namespace
}  // namespace lamella::bubble
