// Bubbles on half a bubble that slides on a wet plate.

#include <gtest/gtest.h>

#include "caps.h"
#include <array>
#include <cstdio>

namespace lamella::melp {
namespace {

constexpr double kSigma = 0.0725;

/// Volume of a sphere beyond a plane `distance` from its center.
double beyond(double radius, double distance) {
    const double h = radius - distance;
    return std::numbers::pi * h * h * (3.0 * radius - h) / 3.0;
}

/// What two spheres lose of their volumes where they meet at 120 degrees: the film between them bulges into the larger.
std::array<double, 2> lost(double large, double small) {
    const double d = std::sqrt(large * large + small * small - large * small);
    const double x = (d * d + large * large - small * small) / (2.0 * d);
    const double border = large * small * std::sqrt(0.75) / d, film = large * small / (large - small);
    const double lens = beyond(film, std::sqrt(film * film - border * border));
    return {beyond(large, x) + lens, beyond(small, d - x) - lens};
}

/// Radii of the caps of half a bubble, a smaller bubble on it and a third, still smaller one on that, of which neither
/// touches what the third has: by Newton's iterations from the volumes.
std::array<double, 3> cap_radii(const std::array<double, 3>& volume) {
    const auto volumes = [](const std::array<double, 3>& r) {
        const auto [half, middle_below] = lost(r[0], r[1]);
        const auto [middle_above, top] = lost(r[1], r[2]);
        const double s = 4.0 / 3.0 * std::numbers::pi;
        return std::array{0.5 * s * std::pow(r[0], 3) - half, s * std::pow(r[1], 3) - middle_below - middle_above,
                          s * std::pow(r[2], 3) - top};
    };
    const double s = 4.0 / 3.0 * std::numbers::pi;
    std::array r{std::cbrt(volume[0] / (0.5 * s)), std::cbrt(volume[1] / s), std::cbrt(volume[2] / s)};
    for (std::size_t k = 0; k < 3; ++k) r[k] *= 1.0 + 0.1 * static_cast<double>(k);
    for (int iteration = 0; iteration < 20; ++iteration) {
        const auto now = volumes(r);
        std::vector<double> slope(9), missing(3);
        for (std::size_t k = 0; k < 3; ++k) {
            auto moved = r;
            moved[k] *= 1.0 + 1e-7;
            const auto then = volumes(moved);
            for (std::size_t i = 0; i < 3; ++i) slope[3 * i + k] = (then[i] - now[i]) / (1e-7 * r[k]);
            missing[k] = volume[k] - now[k];
        }
        std::vector<double> normal(9, 0.0), right(3, 0.0);  // least squares: the matrix is not symmetric
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t i = 0; i < 3; ++i) {
                right[a] += slope[3 * i + a] * missing[i];
                for (std::size_t b = 0; b < 3; ++b) normal[3 * a + b] += slope[3 * i + a] * slope[3 * i + b];
            }
        const auto step = linalg::solve_symmetric(3, normal, right, 0.0).x;
        for (std::size_t k = 0; k < 3; ++k) r[k] += step[k];
    }
    return r;
}

/// Table 12's scene of different sizes, as small as its smallest bubble allows: 10 cm on a plate, 5 and 2.5 cm above.
TEST(DifferentSizes, HavePressuresOfTheirCaps) {
    auto solver = started(
        "[material]\nsurface_tension = 0.0725\nthickness = 5e-7\n"
        "[[bubble]]\nradius = 0.05\ncenter = [0.0, 0.0, 0.1502]\n"
        "[[bubble]]\nradius = 0.025\ncenter = [0.0752, 0.0, 0.1502]\n"
        "[[film]]\nshape = \"hemisphere\"\nradius = 0.1\n[resolution]\nedge_length = 4.16e-3\n"
        "[melp]\nrim = \"wet_plate\"\nfine_ratio = 0\ntheta = 1.0\ndamping = 300.0\n");
    advance_to(*solver, 0.08);
    const double s = 4.0 / 3.0 * std::numbers::pi;
    const auto radius = cap_radii({0.5 * s * std::pow(0.1, 3), s * std::pow(0.05, 3), s * std::pow(0.025, 3)});
    const std::array regions{2U, 0U, 1U};
    const std::array within{0.01, 0.015, 0.025};  // radii of 24, 12 and 6 spacings
    for (std::size_t k = 0; k < 3; ++k) {
        const double pressure = solver->gas()[regions[k]].balanced, expected = 4.0 * kSigma / radius[k];
        std::printf("cap of %.2f cm: pressure %.4f of the closed form\n", 100.0 * radius[k], pressure / expected);
        EXPECT_NEAR(pressure / expected, 1.0, within[k]);
    }
    std::printf("volumes off by %.2f %%, fastest %.3f m/s\n", 100.0 * scalar(*solver, "swept_volume_error"),
                scalar(*solver, "max_velocity"));
    EXPECT_LT(scalar(*solver, "swept_volume_error"), 0.025);
    EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0);
}

/// A bubble on half a bubble is as well anywhere on it as on its top: it stays where it is.
TEST(DifferentSizes, StayWhereTheySit) {
    constexpr double kTilt = 0.7, kFrom = 0.02, kTo = 0.06;  // [rad], [s]
    const Vec3 center = (0.05 + 0.0302) * Vec3{{std::sin(kTilt), 0.0, std::cos(kTilt)}};
    auto solver =
        started("[material]\nsurface_tension = 0.0725\nthickness = 5e-7\n[[bubble]]\nradius = 0.03\ncenter = [" +
                std::to_string(center[0]) + ", 0.0, " + std::to_string(center[2]) +
                "]\n[[film]]\nshape = \"hemisphere\"\nradius = 0.05\n[resolution]\nedge_length = 5e-3\n"
                "[melp]\nrim = \"wet_plate\"\nfine_ratio = 0\ntheta = 1.0\ndamping = 300.0\n");
    const auto tilt = [&] {
        const Cap bubble = cap_of(*solver, 0), half = cap_of(*solver, 1);
        const Vec3 arm = bubble.center - half.center;
        return std::atan2(std::hypot(arm[0], arm[1]), arm[2]);
    };
    advance_to(*solver, kFrom);
    const double before = tilt();
    advance_to(*solver, kTo);
    const double after = tilt();
    std::printf("bubble of 3 on half a bubble of 5 cm: tilt %.4f, then %.4f\n", before, after);
    EXPECT_NEAR(after, before, 0.05);
}

}  // namespace
}  // namespace lamella::melp
