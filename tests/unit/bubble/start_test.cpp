#include <gtest/gtest.h>

#include "foams.h"
#include "lamella/solvers/bubble/start.h"

namespace lamella::bubble {
namespace {

using namespace test;

template <int D>
Foam<D> packed(const Options& o) {
    Foam<D> foam;
    dist::Alone alone;
    pack<D>(o, 7, {}, alone, foam);
    part_coincident<D>(o, 7, foam);
    return foam;
}

template <int D>
double gas_fraction(const Foam<D>& foam) {
    double gas = 0.0;
    for (std::size_t i = 0; i < foam.slots; ++i) gas += Shape<D>::kVolume * foam.size[i];
    return gas / foam.box.volume();
}

TEST(Start, RoundsTheCountUpToAFullGrid) {
    Options o;
    o.count = 100'000;
    EXPECT_EQ(packed<2>(o).slots, 100'489U);  // 317^2, as in the thesis
    o.count = 64;
    EXPECT_EQ(packed<2>(o).slots, 64U);
    EXPECT_EQ(packed<3>(o).slots, 64U);
    o.box_shape = {{4.0, 1.0, 1.0}};
    EXPECT_EQ(packed<2>(o).slots, 64U);  // 16 x 4
}

TEST(Start, HasTheGasFractionOfItsSizeDistributionBeforeScaling) {
    // (pi/4)(1 + 0.21^2) and (pi/6)(1 + 3 0.21^2); five standard errors of N = 40,000 samples
    Options o;
    o.count = 40'000;
    EXPECT_NEAR(gas_fraction(packed<2>(o)), 0.820, 0.009);
    EXPECT_NEAR(gas_fraction(packed<3>(o)), 0.593, 0.010);
}

TEST(Start, ScalesToTheGasFractionExactly) {
    Options o;
    o.count = 1000;
    o.box_shape = {{2.0, 1.0, 1.0}};
    for (const double phi : {0.5, 0.95, 1.1}) {
        auto foam = packed<3>(o);
        dist::Alone alone;
        scale_to_gas_fraction<3>(o, phi, Domain(alone), foam);
        EXPECT_NEAR(gas_fraction(foam), phi, 1e-13);
        EXPECT_NEAR(foam.box.lengths[0], 2.0 * foam.box.lengths[1], 1e-12);
        for (std::size_t i = 0; i < foam.slots; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_GE(foam.position[k][i], 0.0);
                ASSERT_LT(foam.position[k][i], foam.box.lengths[k]);
            }
    }
}

TEST(Start, DrawsTheSizesItSays) {
    Options o;
    o.count = 90'000;
    const auto moments = [&] {
        const auto foam = packed<2>(o);
        double sum = 0.0;
        double squares = 0.0;
        for (std::size_t i = 0; i < foam.slots; ++i) {
            sum += std::sqrt(foam.size[i]);
            squares += foam.size[i];
        }
        const double mean = sum / static_cast<double>(foam.slots);
        return std::pair(mean, std::sqrt(squares / static_cast<double>(foam.slots) - mean * mean));
    };
    o.mean_radius = 2.0;
    o.start.radius_std = 0.4;
    for (const Sizes sizes : {Sizes::kNormal, Sizes::kLognormal}) {
        o.start.sizes = sizes;
        const auto [mean, deviation] = moments();
        EXPECT_NEAR(mean, 2.0, 5.0 * 0.4 / 300);
        EXPECT_NEAR(deviation, 0.4, 0.008);
    }
    o.start.sizes = Sizes::kBidisperse;
    o.start.size_ratio = 3.0;
    o.start.large_fraction = 0.25;
    const auto [mean, deviation] = moments();
    EXPECT_NEAR(mean, 2.0, 0.02);
    EXPECT_NEAR(deviation, 2.0 * 2.0 / 1.5 * std::sqrt(0.25 * 0.75), 0.02);
}

TEST(Start, RelaxesToForceBalance) {
    for (const double phi : {0.7, 0.95}) {
        auto solver = start_solver<2>(coarsening(2, 400, phi));
        double net = 0.0;
        const sim::Frame first = solver->frame();
        for (const double v : first.points.find("velocity")->values) net = std::max(net, std::abs(v));
        EXPECT_LT(net, phi < 0.8 ? 1e-6 : 0.01);  // F0/mu0 = 1
        EXPECT_NEAR(scalar(*solver, "mechanical_time"), 0.0, 0.0);
    }
}

TEST(Start, DilatesAfterRelaxingAtAHigherGasFraction) {
    Options o = coarsening(2, 400, 0.86);
    o.start.relax_gas_fraction = 0.95;
    auto dilated = start_solver<2>(o);
    EXPECT_NEAR(gas_fraction(dilated->system().foam), 0.86, 1e-13);
    o.start.relax_gas_fraction = 0.0;
    auto direct = start_solver<2>(o);
    EXPECT_NEAR(gas_fraction(direct->system().foam), 0.86, 1e-13);
    EXPECT_NE(scalar(*dilated, "energy"), scalar(*direct, "energy"));
}

TEST(Start, ReportsProgressAndStopsWhenAsked) {
    auto solver = make_solver<2>(coarsening(2, 400, 0.95));
    double last = -1.0;
    sim::StartContext context;
    context.progress = [&](std::string_view, double fraction) { last = fraction; };
    solver->start(context);
    EXPECT_EQ(last, 1.0);
    context.stop_requested = [] { return true; };
    EXPECT_THROW(make_solver<2>(coarsening(2, 400, 0.95))->start(context), Interrupted);
}

TEST(Start, RefusesBadFiles) {
    EXPECT_THROW(start_solver<2>(given_options(2, 10.0), {{1, 1, 0, -1.0}}), InputError);
    EXPECT_THROW(start_solver<2>(given_options(2, 10.0), {{std::nan(""), 1, 0, 1.0}}), InputError);
    EXPECT_THROW(start_solver<2>(given_options(2, 10.0), {}), InputError);
}

TEST(CubeRoot, IsExactToTwoUnitsInTheLastPlace) {
    for (double a = 1e-12; a < 1e12; a *= 1.37) EXPECT_NEAR(cube_root(a) / std::cbrt(a), 1.0, 4.5e-16) << a;
}

TEST(Shape, GivesAVanishedBubbleNoRadius) {
    EXPECT_EQ(Shape<2>::radius(0.0), 0.0);
    EXPECT_EQ(Shape<3>::radius(0.0), 0.0);
}

}  // namespace
}  // namespace lamella::bubble
