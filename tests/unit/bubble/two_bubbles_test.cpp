// Two bubbles, R = 1 and 0.7 at distance 1.2: the numbers of the method sheet, section 10.2.

#include <gtest/gtest.h>

#include "foams.h"
#include "lamella/solvers/bubble/contact.h"

namespace lamella::bubble {
namespace {

using namespace test;

const std::vector<Ball> kPair = {{5.0, 5.0, 5.0, 1.0}, {6.2, 5.0, 5.0, 0.7}};

double radius_rate(const sim::Frame& frame, std::size_t i) { return frame.points.find("radius_rate")->values[i]; }

TEST(TwoBubbles, ShareAFilmOfTheRightSize) {
    const double squared = 1.2 * 1.2;
    const Overlap<double> o(squared, 1.0, 0.7);
    EXPECT_NEAR(film_size<2>(squared, o, 1.0, 0.7), 1.1659224, 5e-8);
    EXPECT_NEAR(film_size<3>(squared, o, 1.0, 0.7), 1.0676506, 5e-8);
    EXPECT_EQ(film_size<2>(squared, o, 1.0, 0.7), film_size<2>(squared, o, 0.7, 1.0));
}

TEST(TwoBubbles, FilmIsContinuousWhereTheSmallCenterPassesTheChord) {
    const double border = 1.0 - 0.49;  // d^2 = R_l^2 - R_s^2
    for (const double step : {-1e-9, 1e-9}) {
        const Overlap<double> o(border + step, 1.0, 0.7);
        EXPECT_NEAR(film_size<2>(border + step, o, 1.0, 0.7), 1.4, 1e-6);
    }
}

TEST(TwoBubbles, RelaxExponentially) {
    // d(t) = S - (S - d0) exp(-2 F0 t/(mu0 S)), and the same with another stiffness, drag and unit of length.
    for (const double scale : {1.0, 2.5}) {
        Options o = given_options(2, 20.0 * scale);
        o.mean_radius = scale;
        o.surface_tension = 3.0;
        o.viscosity = 2.0;
        o.integrator.tolerance = 1e-8;
        std::vector<Ball> pair = kPair;
        for (Ball& b : pair) b = {b.x * scale, b.y * scale, 0.0, b.radius * scale};
        auto solver = start_solver<2>(o, pair);
        const double rate = 3.0 * scale / 2.0;  // F0/mu0
        run_to(*solver, 1.0 / 1.5);
        const auto p = solver->frame().points.position;
        const double expected = 1.7 * scale - 0.5 * scale * std::exp(-2.0 * rate / 1.5 / (1.7 * scale));
        EXPECT_NEAR(norm(p[1] - p[0]), expected, 2e-6 * scale);
        if (scale == 1.0) {
            EXPECT_NEAR(expected, 1.5458174, 5e-8);
        }
        EXPECT_EQ(solver->time(), 1.0 / 1.5);
    }
}

TEST(TwoBubbles, HaveTheEnergiesOfBothDefinitions) {
    auto solver = start_solver<2>(given_options(2, 20.0), kPair);
    EXPECT_NEAR(scalar(*solver, "energy"), 0.0735294, 5e-8);
    EXPECT_NEAR(scalar(*solver, "energy_thesis"), 0.25, 1e-12);
    // sigma_xx = -F d/V with F = (S - d)/S
    EXPECT_NEAR(scalar(*solver, "stress_xx"), -0.5 / 1.7 * 1.2 / 400.0, 1e-15);
    EXPECT_NEAR(scalar(*solver, "stress_yy"), 0.0, 1e-18);
}

TEST(TwoBubbles, ExchangeGasThroughTheirFilm) {
    Options o = given_options(2, 20.0);
    o.gas.exchange_rate = 1e-3;
    o.gas.medium_ratio = 0.0;
    const auto frame = start_solver<2>(o, kPair)->frame();
    EXPECT_NEAR(radius_rate(frame, 0), 7.952670e-5, 5e-12);
    EXPECT_NEAR(radius_rate(frame, 1), -1.1360958e-4, 5e-12);
}

TEST(TwoBubbles, ExchangeGasThroughTheLiquid) {
    // By a plain evaluation of eq. 2.29 with <A_in> = <A>.
    Options o = given_options(2, 20.0);
    o.gas.exchange_rate = 1e-3;
    o.gas.medium_ratio = 0.1;
    auto disc_solver = start_solver<2>(o, kPair);
    EXPECT_NEAR(scalar(*disc_solver, "critical_radius"), 0.8576994, 5e-8);
    const auto discs = disc_solver->frame();
    EXPECT_NEAR(radius_rate(discs, 0), 9.303901e-5, 5e-12);
    EXPECT_NEAR(radius_rate(discs, 1), -1.3291288e-4, 5e-12);

    o.dimension = 3;
    auto ball_solver = start_solver<3>(o, kPair);
    EXPECT_NEAR(scalar(*ball_solver, "critical_radius"), 0.8837838, 5e-8);
    const auto balls = ball_solver->frame();
    EXPECT_NEAR(radius_rate(balls, 0), 4.844445e-5, 5e-12);
    EXPECT_NEAR(radius_rate(balls, 1), -9.886622e-5, 5e-12);
}

TEST(TwoBubbles, ObeyLifshitzSlyozovWagnerWhenApart) {
    // dR/dt = (K_LSW/R) (1/rho - 1/R), K_LSW = kappa K <R_in>, rho = <R>   [Lankinen20, eq. 2.6]
    Options o = given_options(3, 20.0);
    o.gas.exchange_rate = 2e-3;
    o.gas.medium_ratio = 0.3;
    o.gas.medium_scaling = MediumScaling::kLsw;
    o.mean_radius = 1.1;
    const auto frame = start_solver<3>(o, {{5, 5, 5, 1.5}, {15, 15, 15, 0.9}})->frame();
    const double k = 0.3 * 2e-3 * 1.1;
    EXPECT_NEAR(radius_rate(frame, 0), k / 1.5 * (1 / 1.2 - 1 / 1.5), 1e-16);
    EXPECT_NEAR(radius_rate(frame, 1), k / 0.9 * (1 / 1.2 - 1 / 0.9), 1e-16);
}

TEST(TwoBubbles, PushEachOtherAcrossAPeriodicBorder) {
    auto inside = start_solver<2>(given_options(2, 10.0), {{5.0, 5.0, 0, 1.0}, {6.2, 5.0, 0, 0.7}});
    auto across = start_solver<2>(given_options(2, 10.0), {{9.5, 9.9, 0, 1.0}, {0.7, 9.9, 0, 0.7}});
    EXPECT_NEAR(scalar(*inside, "energy"), scalar(*across, "energy"), 1e-14);
    run_to(*across, 3.0);
    const sim::Frame frame = across->frame();
    for (const Vec3& p : frame.points.position) {
        EXPECT_GE(p[0], 0.0);
        EXPECT_LT(p[0], 10.0);
    }
    // The displacement is unwrapped.
    const auto& moved = frame.points.find("displacement")->values;
    EXPECT_LT(std::abs(moved[0]), 0.5);
    EXPECT_NEAR(moved[0], -moved[3], 1e-12);
}

TEST(TwoBubbles, AtTheVerySamePointPartInsteadOfBlowingUp) {
    auto solver = start_solver<2>(given_options(2, 10.0), {{5, 5, 0, 1.0}, {5, 5, 0, 1.0}});
    run_to(*solver, 50.0);
    const auto p = solver->frame().points.position;
    EXPECT_NEAR(norm(p[1] - p[0]), 2.0, 1e-3);
}

/// Error at t = 1 of fixed steps h.
double error_of(Method method, bool again, double h) {
    Options o = given_options(2, 20.0);
    o.integrator.method = method;
    o.integrator.evaluate_again = again;
    o.integrator.tolerance = 1e3;  // accept everything
    o.integrator.initial_step = o.integrator.max_step = h;
    auto solver = start_solver<2>(o, kPair);
    run_to(*solver, 1.0);
    EXPECT_EQ(solver->step(), std::llround(1.0 / h));
    const auto p = solver->frame().points.position;
    return std::abs(norm(p[1] - p[0]) - (1.7 - 0.5 * std::exp(-2.0 / 1.7)));
}

TEST(TwoBubbles, ConvergeAtSecondOrderWithEveryIntegrator) {
    struct Case {
        Method method;
        bool again;
    };
    for (const Case c : {Case{Method::kAbm2, false}, Case{Method::kAbm2, true}, Case{Method::kRkc2, false}}) {
        const double coarse = error_of(c.method, c.again, 1.0 / 32);
        const double middle = error_of(c.method, c.again, 1.0 / 64);
        const double fine = error_of(c.method, c.again, 1.0 / 128);
        EXPECT_NEAR(std::log2(coarse / middle), 2.0, 0.25);
        EXPECT_NEAR(std::log2(middle / fine), 2.0, 0.15);
    }
}

}  // namespace
}  // namespace lamella::bubble
