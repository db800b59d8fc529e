// Growth laws: <R> ~ tau^alpha. Minutes long.

#include <gtest/gtest.h>

#include "../../unit/bubble/foams.h"

namespace lamella::bubble {
namespace {

using namespace test;

struct Point {
    double time, mean_radius;
};

template <int D>
std::vector<Point> history(const Options& options, double from, double to, int points) {
    auto solver = start_solver<D>(options);
    std::vector<Point> list;
    for (int k = 0; k <= points; ++k) {
        const double tau = from * std::pow(to / from, static_cast<double>(k) / points);
        run_to(*solver, tau);
        if (solver->stop_reason()) break;
        list.push_back({tau, solver->system().mean_radius()});
    }
    EXPECT_LT(std::abs(scalar(*solver, "volume_error")), 1e-12);
    return list;
}

/// Least-squares slope of ln <R> on ln tau, points equally spaced in ln tau.
double exponent(const std::vector<Point>& list) {
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const Point& p : list) {
        x += std::log(p.time);
        y += std::log(p.mean_radius);
        xx += std::log(p.time) * std::log(p.time);
        xy += std::log(p.time) * std::log(p.mean_radius);
    }
    const auto n = static_cast<double>(list.size());
    return (n * xy - x * y) / (n * xx - x * x);
}

TEST(Exponents, RiseWithTheGasFractionFromOneThirdToOneHalf) {
    struct Case {
        double gas_fraction, alpha;
        int count;
    };
    double last = 0.0;
    // [Lankinen20, fig. 4.1]; values of the method sheet, 10.6, window tau 20 to 100
    for (const Case c : {Case{0.84, 0.34, 10000}, Case{0.90, 0.42, 16000}, Case{0.95, 0.46, 20000}, Case{1.00, 0.48, 30000}}) {
        const double alpha = exponent(history<2>(coarsening(2, c.count, c.gas_fraction), 20.0, 100.0, 40));
        RecordProperty("alpha_" + std::to_string(c.gas_fraction), std::to_string(alpha));
        std::printf("gas fraction %.2f: alpha = %.4f\n", c.gas_fraction, alpha);
        EXPECT_NEAR(alpha, c.alpha, 0.03) << "gas fraction " << c.gas_fraction;
        EXPECT_GT(alpha, last);
        last = alpha;
    }
}

Options dilute(int dimension, MediumScaling scaling) {
    Options o = coarsening(dimension, 20'000, 0.02);
    o.gas.medium_scaling = scaling;
    return o;
}

TEST(Exponents, OfADiluteFoamFollowTheScalingOfTheMedium) {
    // Method sheet, 3.4 and 10.5: without contacts the mean-field equations give these laws.
    struct Case {
        int dimension;
        MediumScaling scaling;
        double alpha;
        const char* name;
    };
    for (const Case c : {Case{2, MediumScaling::kArea, 1.0 / 3.0, "2D area"}, Case{3, MediumScaling::kArea, 0.25, "3D area"},
                         Case{3, MediumScaling::kRadius, 1.0 / 3.0, "3D radius"},
                         Case{3, MediumScaling::kLsw, 1.0 / 3.0, "3D lsw"}}) {
        const Options o = dilute(c.dimension, c.scaling);
        const auto list = c.dimension == 2 ? history<2>(o, 200.0, 1600.0, 12) : history<3>(o, 200.0, 1600.0, 12);
        const double alpha = exponent(list);
        std::printf("%s: alpha = %.4f\n", c.name, alpha);
        EXPECT_NEAR(alpha, c.alpha, 0.03) << c.name;
        if (c.scaling != MediumScaling::kLsw) continue;
        // <R>^3 = (4/9) K_LSW t, K_LSW = kappa K <R_in>: per tau (4/9) kappa   [Lankinen20, eq. 2.7]
        const auto cube = [](double r) { return r * r * r; };
        const double slope = (cube(list.back().mean_radius) - cube(list[6].mean_radius)) / (list.back().time - list[6].time);
        std::printf("3D lsw: d<R>^3/dtau = %.5f, theory %.5f\n", slope, 4.0 / 9.0 * 0.1);
        EXPECT_NEAR(slope, 4.0 / 9.0 * 0.1, 0.15 * 4.0 / 9.0 * 0.1);
    }
}

TEST(Exponents, TrackTheReferenceTrajectory) {
    // Prototype, phi 0.95, N0 = 10000, true clock (method sheet, 10.6): 2 % up to tau 20, 5 % later.
    auto solver = start_solver<2>(coarsening(2, 10000, 0.95));
    struct Point95 {
        double tau, mean_radius, share, tolerance;
    };
    for (const Point95 p : {Point95{10, 1.731, 0.281, 0.02}, Point95{20, 2.308, 0.154, 0.03}, Point95{50, 3.51, 0.0652, 0.05},
                            Point95{100, 4.85, 0.033, 0.06}}) {
        run_to(*solver, p.tau);
        const double radius = solver->system().mean_radius();
        const double share = static_cast<double>(solver->system().foam.live) / 10000.0;
        std::printf("tau %.0f: <R> = %.4f (%.3f), N/N0 = %.4f (%.4f)\n", p.tau, radius, p.mean_radius, share, p.share);
        EXPECT_NEAR(radius, p.mean_radius, p.tolerance * p.mean_radius);
        EXPECT_NEAR(share, p.share, 2.0 * p.tolerance * p.share);
    }
}

}  // namespace
}  // namespace lamella::bubble
