// Walls, prescribed flow, and the drag models.

#include <gtest/gtest.h>

#include "foams.h"

namespace lamella::bubble {
namespace {

using namespace test;

Vec3 velocity(const sim::Frame& frame, std::size_t i) {
    const auto& v = frame.points.find("velocity")->values;
    return {{v[3 * i], v[3 * i + 1], v[3 * i + 2]}};
}

TEST(Walls, PushABubbleOutExponentially) {
    // delta(t) = R - (R - delta0) exp(-t/R)
    Options o = given_options(2, 20.0);
    o.walls = {true, false, false};
    o.integrator.tolerance = 1e-8;
    auto solver = start_solver<2>(o, {{0.4, 5.0, 0, 1.0}, {19.5, 12.0, 0, 0.8}});
    run_to(*solver, 1.0);
    const auto p = solver->frame().points.position;
    EXPECT_NEAR(p[0][0], 1.0 - 0.6 * std::exp(-1.0), 1e-6);
    EXPECT_NEAR(20.0 - p[1][0], 0.8 - 0.3 * std::exp(-1.0 / 0.8), 1e-6);
}

TEST(Walls, BringBackACenterThatCrossed) {
    Options o = given_options(2, 20.0);
    o.walls = {true, true, false};
    auto solver = start_solver<2>(o, {{-0.2, 5.0, 0, 1.0}, {10.0, 5.0, 0, 1.0}});
    EXPECT_NEAR(velocity(solver->frame(), 0)[0], 1.2, 1e-14);
    run_to(*solver, 20.0);
    EXPECT_NEAR(solver->frame().points.position[0][0], 1.0, 1e-3);
}

TEST(Walls, RubOnlyAlongThemselvesAndKnowNoOrderOfAxes) {
    Options o = given_options(2, 20.0);
    o.walls = {true, true, false};
    o.wall_drag = 0.25;
    o.flow.kind = FlowKind::kUniform;
    o.flow.velocity = {{0.3, 0.3, 0.0}};
    const auto corner = start_solver<2>(o, {{0.5, 0.5, 0, 1.0}})->frame();
    EXPECT_NEAR(velocity(corner, 0)[0], 0.75 * 0.3 + 0.5, 1e-14);
    EXPECT_NEAR(velocity(corner, 0)[1], 0.75 * 0.3 + 0.5, 1e-14);
    const auto edge = start_solver<2>(o, {{0.5, 9.0, 0, 1.0}})->frame();
    EXPECT_NEAR(velocity(edge, 0)[0], 0.3 + 0.5, 1e-14);
    EXPECT_NEAR(velocity(edge, 0)[1], 0.75 * 0.3, 1e-14);
}

TEST(Walls, BlockGasWhereAskedTo) {
    Options o = given_options(2, 20.0);
    o.walls = {true, false, false};
    o.gas.exchange_rate = 1e-3;
    const std::vector<Ball> balls = {{0.6, 5.0, 0, 1.0}, {10.0, 10.0, 0, 0.5}};
    const auto rate = [&] {
        const sim::Frame frame = start_solver<2>(o, balls)->frame();
        return frame.points.find("radius_rate")->values[0];
    };
    const double open = rate();
    o.wall_blocks_gas = true;
    const double blocked = rate();
    // w = 2 pi R - 2 sqrt(R^2 - delta^2) in all sums
    const double pi = std::numbers::pi;
    const double w0 = 2.0 * pi - 1.6;
    const double w1 = pi;
    const double inverse_rho = (w0 + w1 / 0.5) / (w0 + w1);
    EXPECT_NEAR(blocked, 1e-4 * w0 * (inverse_rho - 1.0) / (2.0 * pi), 1e-16);
    EXPECT_GT(std::abs(open - blocked), 1e-7);
}

TEST(Flow, CarriesTheBubblesOfItsRegionOnly) {
    Options o = given_options(2, 20.0);
    o.flow.kind = FlowKind::kRegion;
    o.flow.velocity = {{0.01, 0.0, 0.0}};
    const std::vector<Ball> balls = {{3, 10, 0, 1.0}, {3, 11.4, 0, 1.0}, {3, 11.6, 0, 1.0}, {3, 2, 0, 1.0}};
    o.flow.region_low = {{0.0, 0.475, 0.0}};   // y from 9.5
    o.flow.region_high = {{1.0, 0.525, 1.0}};  // to 10.5, widened by the radius
    std::vector<double> along;
    for (const Ball& ball : balls) along.push_back(velocity(start_solver<2>(o, {ball})->frame(), 0)[0]);
    EXPECT_EQ(along, (std::vector<double>{0.01, 0.01, 0.0, 0.0}));
    o.flow.edge_width = 0.2;
    EXPECT_NEAR(velocity(start_solver<2>(o, {balls[2]})->frame(), 0)[0], 0.005, 1e-12);
}

TEST(Flow, ShearsBetweenWallsThatMoveWithIt) {
    Options o = given_options(2, 20.0);
    o.walls = {false, true, false};
    o.flow.kind = FlowKind::kShear;
    o.flow.shear_rate = 0.1;
    o.wall_drag = 1.0;
    const auto frame = start_solver<2>(o, {{5, 10, 0, 1}, {5, 15, 0, 1}, {5, 0.5, 0, 1}})->frame();
    EXPECT_NEAR(velocity(frame, 0)[0], 0.0, 1e-15);
    EXPECT_NEAR(velocity(frame, 1)[0], 0.5, 1e-14);
    EXPECT_NEAR(velocity(frame, 2)[0], -1.0, 1e-14);  // sticks to the lower wall
}

TEST(NeighborLaggedDrag, AddsTheMeanVelocityOfTouchingBubblesAtTheLastStep) {
    Options o = given_options(2, 20.0);
    o.drag = Drag::kNeighborLagged;
    o.integrator.max_step = o.integrator.initial_step = 1e-6;
    o.integrator.tolerance = 1e3;
    auto solver = start_solver<2>(o, {{5.0, 5.0, 0, 1.0}, {6.2, 5.0, 0, 0.7}});
    const double push = (1.0 / 1.2 - 1.0 / 1.7) * 1.2;
    // At the start there is no last step; later each adds the other's old velocity, which is its own with a minus.
    EXPECT_NEAR(velocity(solver->frame(), 1)[0], push, 1e-14);
    solver->advance(1.0);
    EXPECT_NEAR(velocity(solver->frame(), 1)[0], push - push, 1e-5);
}

TEST(PairwiseDrag, SolvesForTheVelocitiesOfAPair) {
    // mu0 v + mu_b (v - v') = F for an antisymmetric pair: v = F/(mu0 + 2 mu_b)
    Options o = given_options(2, 20.0);
    o.drag = Drag::kPairwise;
    o.pair_viscosity = 3.0;
    o.viscosity = 2.0;
    const auto frame = start_solver<2>(o, {{5.0, 5.0, 0, 1.0}, {6.2, 5.0, 0, 0.7}})->frame();
    const double force = 0.5 / 1.7;
    EXPECT_NEAR(velocity(frame, 1)[0], force / (2.0 + 6.0), 1e-10);
    EXPECT_NEAR(velocity(frame, 0)[0], -force / (2.0 + 6.0), 1e-10);
}

TEST(PairwiseDrag, BalancesForcesOfAWholeFoam) {
    // Sum of mu0 (v - U) = sum of contact forces = 0: in a uniform flow the mean velocity is that of the liquid.
    Options o = coarsening(2, 400, 0.95);
    o.drag = Drag::kPairwise;
    o.flow.kind = FlowKind::kUniform;
    o.flow.velocity = {{0.2, -0.1, 0.0}};
    const auto frame = start_solver<2>(o)->frame();
    Vec3 mean;
    for (std::size_t i = 0; i < frame.points.size(); ++i) mean += velocity(frame, i) / 400.0;
    EXPECT_NEAR(mean[0], 0.2, 1e-9);
    EXPECT_NEAR(mean[1], -0.1, 1e-9);
}

}  // namespace
}  // namespace lamella::bubble
