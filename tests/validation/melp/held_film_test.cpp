// Films on rims against closed forms.

#include <gtest/gtest.h>

#include "../../unit/melp/bubbles.h"

namespace lamella::melp {
namespace {

constexpr const char* kDisk = "[[film]]\nshape = \"disk\"\nradius = 0.05\n";

/// Mean height of a film that lies in the plane z = 0 [m].
double height(const MelpSolver& solver) {
    double sum = 0.0, area = 0.0;
    for (std::size_t i = 0; i < solver.coarse().size(); ++i) {
        sum += solver.geometry().area[i] * solver.coarse().position[i][2];
        area += solver.geometry().area[i];
    }
    return sum / area;
}

/// Amplitude of a mode of half a bubble on z = 0 about its center [m].
double half_mode(const MelpSolver& solver, int l) {
    double sum = 0.0, angle = 0.0;
    for (std::size_t i = 0; i < solver.coarse().size(); ++i) {
        const Vec3& d = solver.coarse().position[i];
        const double r = norm(d), solid = solver.geometry().area[i] * dot(solver.geometry().normal[i], d) / (r * r * r);
        sum += solid * r * legendre(l, d[0] / r);
        angle += solid;
    }
    return (2 * l + 1) * sum / angle;
}

/// A disk at rest that its weight is put on swings about z = g (R^2 - r^2) / (4 c^2) mostly in its first mode,
/// omega = 2.4048 c / R.
TEST(HeldFilm, DiskSwingsAsADrum) {
    auto solver = films(kDisk, 0.0025, "fine_ratio = 0\nsteps_per_period = 100.0", "gravity = [0.0, 0.0, -9.81]");
    const double sag = -9.81 * 0.05 * 0.05 / (8.0 * kWaveSpeed * kWaveSpeed);
    const double swing = period(*solver, 4, [&] { return height(*solver) - sag; });
    const double ratio = 2.0 * std::numbers::pi / swing / (2.404825557695773 * kWaveSpeed / 0.05);
    std::printf("drum, %zu coarse: %.4f\n", solver->coarse().size(), ratio);
    EXPECT_NEAR(ratio, 1.0, 0.02);
}

TEST(HeldFilm, DiskSagsUnderItsWeight) {
    auto solver = films(kDisk, 0.0025, "fine_ratio = 0\ndamping = 300.0", "gravity = [0.0, 0.0, -9.81]");
    advance_to(*solver, 0.1);
    const double sag = -9.81 * 0.05 * 0.05 / (8.0 * kWaveSpeed * kWaveSpeed);
    std::printf("sag: %.4f\n", height(*solver) / sag);
    EXPECT_NEAR(height(*solver) / sag, 1.0, 0.02);
}

constexpr const char* kHalf = "[[film]]\nshape = \"hemisphere\"\nradius = 0.05\n";

/// Half a bubble that slides on a plate swings as half of a whole one.
TEST(HeldFilm, HalfBubbleOnAWetPlateSwingsInMode2) {
    auto solver = films(kHalf, 0.0051,
                        "fine_ratio = 0\nrim = \"wet_plate\"\nstart.mode_amplitude = 0.01\n"
                        "steps_per_period = 100.0");
    const double swing = period(*solver, 4, [&] { return half_mode(*solver, 2); });
    const double ratio = 2.0 * std::numbers::pi / swing / 400.0;
    std::printf("half bubble, %zu coarse, l = 2: %.4f\n", solver->coarse().size(), ratio);
    EXPECT_NEAR(ratio, 1.0, 0.02);
}

/// On either plate it stays at rest with the pressure of Young and Laplace.
TEST(HeldFilm, HalfBubbleRestsOnAPlate) {
    for (const char* rim : {"plate", "wet_plate"}) {
        auto solver = films(kHalf, 0.0051,
                            "fine_ratio = 0\nrim = \"" + std::string(rim) +
                                "\"\ntheta = 1.0\nsteps_per_period = 0.0\nlargest_step = 2e-3\n");
        advance_to(*solver, 1.0);
        double farthest = 0.0;
        for (const Vec3& x : solver->coarse().position) farthest = std::max(farthest, std::abs(norm(x) / 0.05 - 1.0));
        std::printf("half bubble, %s: pressure %.4f, farthest from the sphere %.1e, fastest %.1e\n", rim,
                    scalar(*solver, "gauge_pressure_1"), farthest, scalar(*solver, "max_velocity"));
        EXPECT_NEAR(scalar(*solver, "gauge_pressure_1"), 2.0, 0.02);
        EXPECT_LT(farthest, 0.003);
        EXPECT_LT(scalar(*solver, "max_velocity"), 1e-4 * kWaveSpeed);
    }
}

/// Liquid sinks in a vertical film until eta = C exp(-k z), k = rho g eta_0 / (2 R T Gamma_0).
TEST(HeldFilm, VerticalRectangleDrainsToAnExponential) {
    auto solver = films("[[film]]\nshape = \"rectangle\"\nu = [0.08, 0.0, 0.0]\nv = [0.0, 0.0, 0.06]\n", 0.0025,
                        "steps_per_period = 0.0\nlargest_step = 5e-3\nair_drag = 1e-3", "gravity = [0.0, 0.0, -9.81]");
    advance_to(*solver, 3.0);
    const double k = 1000.0 * 9.81 * 5e-7 / (2.0 * 8.31446261815324 * 298.15 * 1e-7), x = 0.5 * k * 0.06;
    double n = 0.0, z1 = 0.0, z2 = 0.0, y1 = 0.0, zy = 0.0, square = 0.0;
    for (std::size_t i = 0; i < solver->coarse().size(); ++i) {
        const double z = solver->coarse().position[i][2] - 0.03, eta = solver->films().thickness[i], y = std::log(eta);
        n += 1.0;
        z1 += z;
        z2 += z * z;
        y1 += y;
        zy += z * y;
        const double exact = 5e-7 * x / std::sinh(x) * std::exp(-k * z);
        square += (eta / exact - 1.0) * (eta / exact - 1.0);
    }
    const double slope = (zy - z1 * y1 / n) / (z2 - z1 * z1 / n), rms = std::sqrt(square / n);
    std::printf("drainage, %.0f coarse: slope %.4f k, rms %.4f, fastest %.1e, liquid %.1e\n", n, -slope / k, rms,
                scalar(*solver, "max_velocity"), scalar(*solver, "liquid_error"));
    EXPECT_NEAR(-slope / k, 1.0, 0.005);
    EXPECT_LT(rms, 0.02);
}

TEST(HeldFilm, UnevenLiquidOfADiskEvensOut) {
    auto solver = films(kDisk, 0.00273, "steps_per_period = 0.0\nlargest_step = 5e-3\nstart.thickness_noise = 0.5");
    const auto spread = [&] {
        return scalar(*solver, "film_thickness_deviation") / scalar(*solver, "film_thickness_mean");
    };
    const double before = spread();
    advance_to(*solver, 1.0);
    std::printf("equalisation, %zu coarse: %.4f to %.5f\n", solver->coarse().size(), before, spread());
    EXPECT_GT(before, 0.1);
    EXPECT_LT(spread(), 0.01);
}

}  // namespace
}  // namespace lamella::melp
