// What must hold for a whole foam: conservation, the same bits whatever the threads, lists and interruptions, energy.

#include "lamella/core/parallel.h"

#include <gtest/gtest.h>

#include "foams.h"

namespace lamella::bubble {
namespace {

using namespace test;

template <int D>
Memory run_and_save(const Options& o, double time, int threads) {
    ThreadLimit limit(threads);
    auto solver = start_solver<D>(o);
    run_to(*solver, time);
    return saved(*solver);
}

TEST(Foam, KeepsItsGasThroughHundredsOfRemovals) {
    for (const Method method : {Method::kRkc2, Method::kAbm2}) {
        Options o = coarsening(2, 900, 0.95);
        o.integrator.method = method;
        auto solver = start_solver<2>(o);
        run_to(*solver, 4.0);
        EXPECT_LT(solver->frame().points.size(), 650U);
        EXPECT_LT(std::abs(scalar(*solver, "volume_error")), 1e-13);
    }
    Options o = coarsening(3, 1000, 0.8);
    o.gas.exchange_rate = 5e-3;
    auto solver = start_solver<3>(o);
    run_to(*solver, 8.0);
    EXPECT_LT(solver->frame().points.size(), 800U);
    EXPECT_LT(std::abs(scalar(*solver, "volume_error")), 1e-13);
}

TEST(Foam, HasTheSameBitsOnAnyNumberOfThreads) {
    EXPECT_EQ(run_and_save<2>(coarsening(2, 9000, 0.9), 0.02, 1), run_and_save<2>(coarsening(2, 9000, 0.9), 0.02, 2));
    EXPECT_EQ(run_and_save<3>(coarsening(3, 9000, 0.7), 0.02, 1), run_and_save<3>(coarsening(3, 9000, 0.7), 0.02, 2));
}

TEST(Foam, HasTheSameBitsWhenNeighborListsAreBuiltAtOtherTimes) {
    for (const Method method : {Method::kRkc2, Method::kAbm2}) {
        Options o = coarsening(2, 400, 0.95);
        o.integrator.method = method;
        const Memory usual = run_and_save<2>(o, 1.5, 1);
        o.integrator.skin = 0.07;
        EXPECT_EQ(run_and_save<2>(o, 1.5, 1), usual);
        o.integrator.skin = 1.3;
        EXPECT_EQ(run_and_save<2>(o, 1.5, 1), usual);
    }
}

TEST(Foam, ContinuesFromASavedStateBitForBit) {
    for (const Method method : {Method::kRkc2, Method::kAbm2}) {
        for (const Drag drag : {Drag::kBackground, Drag::kNeighborLagged, Drag::kPairwise}) {
            Options o = coarsening(2, 256, 0.95);
            o.integrator.method = method;
            o.drag = drag;
            auto whole = start_solver<2>(o);
            run_to(*whole, 0.4);
            Memory middle = saved(*whole);
            run_to(*whole, 0.8);

            auto second = make_solver<2>(o);
            second->load(middle);
            EXPECT_EQ(saved(*second), middle);
            run_to(*second, 0.8);
            EXPECT_EQ(saved(*second), saved(*whole))
                << "method " << static_cast<int>(method) << ", drag " << static_cast<int>(drag);
        }
    }
}

TEST(Foam, RefusesAStateThatDoesNotFit) {
    const Memory good = run_and_save<2>(coarsening(2, 100, 0.9), 0.01, 1);
    const auto refused = [&](auto&& spoil) {
        Memory bad = good;
        spoil(bad.entries);
        auto solver = make_solver<2>(coarsening(2, 100, 0.9));
        EXPECT_THROW(solver->load(bad), InputError);
    };
    refused([](auto& e) { e["dimension"] = std::vector<std::int64_t>{3}; });
    refused([](auto& e) { e["bubbles"] = std::vector<std::int64_t>{-1}; });
    refused([](auto& e) { e["bubbles"] = std::vector<std::int64_t>{99}; });
    refused([](auto& e) { e["start_count"] = std::vector<std::int64_t>{5}; });
    refused([](auto& e) { e["box/length_0"] = std::vector<double>{std::nan("")}; });
    refused([](auto& e) { std::get<std::vector<double>>(e["foam/position_x"])[7] = std::nan(""); });
    refused([](auto& e) { std::get<std::vector<double>>(e["foam/size"])[7] = -1.0; });
    refused([](auto& e) { e.erase("foam/velocity_y"); });
}

TEST(Foam, LosesEnergyAtEveryStepWhileGasRests) {
    Options o = coarsening(2, 400, 0.95);
    o.gas.exchange_rate = 0.0;
    o.time_unit = TimeUnit::kMechanical;
    o.start.max_iterations = 0;  // far from rest
    o.integrator.tolerance = 1e-4;
    for (const Method method : {Method::kRkc2, Method::kAbm2}) {
        o.integrator.method = method;
        auto solver = start_solver<2>(o);
        double energy = scalar(*solver, "energy");
        for (int step = 0; step < 300; ++step) {
            solver->advance(1e9);
            const double next = scalar(*solver, "energy");
            ASSERT_LE(next, energy) << "step " << step;
            energy = next;
        }
    }
}

TEST(Foam, DissipatesTheWorkOfItsForces) {
    // dE/dt = -mu0 sum |v|^2 at constant radii
    Options o = coarsening(2, 400, 0.95);
    o.gas.exchange_rate = 0.0;
    o.time_unit = TimeUnit::kMechanical;
    o.start.max_iterations = 0;
    o.viscosity = 2.0;
    o.integrator.initial_step = 1e-5;
    auto solver = start_solver<2>(o);
    double power = 0.0;
    const sim::Frame first = solver->frame();
    for (const double v : first.points.find("velocity")->values) power += 2.0 * v * v;
    const double before = scalar(*solver, "energy");
    solver->advance(1e-5);
    EXPECT_NEAR((before - scalar(*solver, "energy")) / 1e-5, power, 1e-3 * power);
}

TEST(Foam, RunsDownToItsLastBubbles) {
    // Few bubbles in a small box touch each other through several periodic images.
    Options o = coarsening(2, 60, 0.9);
    o.end_count = 2;
    // Some seeds come to a small bubble that is squeezed onto the very center of a large one, where the push has no
    // direction: steps of 1e-5, as it should.
    auto solver = start_solver<2>(o, {}, 6);
    for (int step = 0; step < 200'000 && !solver->stop_reason(); ++step) solver->advance(1e9);
    ASSERT_TRUE(solver->stop_reason().has_value());
    EXPECT_LE(solver->frame().points.size(), 12U);
    EXPECT_LT(std::abs(scalar(*solver, "volume_error")), 1e-13);
}

TEST(Foam, FollowsBubblesThatCrossTheBorderOfASmallBox) {
    // Pairs that touch through several images keep them while a flow carries them around: when lists are built anew,
    // seldom or often, must not change a bit.
    Memory first;
    for (const double skin : {0.07, 0.3, 1.3}) {
        Options o = coarsening(2, 12, 0.95);
        o.end_count = 2;
        o.flow.kind = FlowKind::kUniform;
        o.flow.velocity = {{0.3, 0.1, 0.0}};
        o.integrator.skin = skin;
        auto solver = start_solver<2>(o);
        for (int k = 0; k < 150; ++k) solver->advance(1e9);
        if (skin == 1.3) {
            EXPECT_TRUE(solver->system().neighbors().has_images());
        }
        const Memory now = saved(*solver);
        if (skin == 0.07)
            first = now;
        else
            EXPECT_TRUE(now == first) << skin;
    }
}

TEST(Foam, GivesAnEventForEveryBubbleThatVanishes) {
    auto solver = start_solver<2>(coarsening(2, 400, 0.95));
    run_to(*solver, 2.0);
    const auto events = solver->take_events();
    EXPECT_GT(events.size(), 20U);
    EXPECT_EQ(events.size() + solver->frame().points.size(), 400U);
    for (const auto& event : events) EXPECT_EQ(event.kind, "remove");
    EXPECT_TRUE(solver->take_events().empty());
}

TEST(Foam, ShrinksWhereTheThesisMadeGas) {
    Options o = coarsening(2, 400, 0.95);
    o.compat.removal = true;
    auto solver = start_solver<2>(o);
    run_to(*solver, 2.0);
    EXPECT_GT(scalar(*solver, "volume_error"), 0.1);  // 0.2 % and more per removal
}

TEST(Foam, RefusesOptionsThatDoNotGoTogether) {
    const auto refused = [](auto&& change) {
        Options o;
        change(o);
        EXPECT_THROW(make_solver<2>(o), InputError);
    };
    refused([](Options& o) { o.gas.exchange_rate = 0.0; });
    refused([](Options& o) { o.gas.medium_scaling = MediumScaling::kLsw; });
    refused([](Options& o) { o.start.packing = Packing::kFile; });
    refused([](Options& o) { o.flow.kind = FlowKind::kShear; });
    refused([](Options& o) { o.compat.clock = true; });
}

}  // namespace
}  // namespace lamella::bubble
