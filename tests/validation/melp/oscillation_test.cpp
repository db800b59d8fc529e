// Bubbles that swing, against reference/reference.json, oscillation/{film_only, with_air}/eta=5e-07.

#include <gtest/gtest.h>

#include "../../unit/melp/bubbles.h"

namespace lamella::melp {
namespace {

/// rad/s, from two swings of a bubble that starts with 1 % of the mode.
double frequency(double particles, int mode, const std::string& options) {
    auto solver =
        bubble(particles, "start.mode = " + std::to_string(mode) + "\nstart.mode_amplitude = 0.01\n" + options,
               "air_density = 1.2\n");
    return 2.0 * std::numbers::pi / period(*solver, 4, [&] { return shape_mode(*solver, mode); });
}

constexpr double kFilmOnly[] = {400.0, 632.4555320336758, 848.5281374238571};  // l = 2, 3, 4

// Measured, over the closed form, for l = 2, 3, 4 and 1200 particles with 100 steps per swing in mode 2: see
// docs/melp.md.
TEST(Oscillation, HasTheFrequenciesOfABubbleWhoseFilmAloneHasMass) {
    for (const int mode : {2, 3}) {
        const double ratio = frequency(1200, mode, "fine_ratio = 0\nsteps_per_period = 100.0") / kFilmOnly[mode - 2];
        RecordProperty("mode_" + std::to_string(mode), std::to_string(ratio));
        std::printf("film only, l = %d: %.4f\n", mode, ratio);
        EXPECT_NEAR(ratio, 1.0, 0.02) << mode;
    }
}

TEST(Oscillation, IsTheSameWithTheLiquidOnFineParticles) {
    const double ratio = frequency(1200, 2, "fine_ratio = 16\nsteps_per_period = 60.0") / kFilmOnly[0];
    std::printf("film only, with fine particles, l = 2: %.4f\n", ratio);
    EXPECT_NEAR(ratio, 1.0, 0.02);
}

TEST(Oscillation, IsSlowerByTheAirThatSwingsAlong) {
    const double exact =
        std::sqrt(2.0 * kTension * 4.0 / (kRadius * kRadius * (1000.0 * 5e-7 + 1.2 * kRadius * 5.0 / 6.0)));
    const double ratio =
        frequency(1200, 2, "fine_ratio = 0\nair_mass = 0.8333333333\nsteps_per_period = 100.0") / exact;
    std::printf("with air, l = 2: %.4f of %.4f\n", ratio, exact);
    EXPECT_NEAR(ratio, 1.0, 0.02);
}

/// The middle of a step hardly damps: what is lost comes from the filter and from redistribution.
TEST(Oscillation, KeepsItsAmplitude) {
    auto solver = bubble(1200, "fine_ratio = 0\nstart.mode_amplitude = 0.01\nsteps_per_period = 40.0");
    const double swing = 2.0 * std::numbers::pi / kFilmOnly[0];
    const auto largest = [&](double until) {
        double most = 0.0;
        while (solver->time() < until) {
            solver->advance(until);
            most = std::max(most, std::abs(shape_mode(*solver, 2)));
        }
        return most;
    };
    const double early = largest(1.5 * swing), late = (largest(4.0 * swing), largest(5.5 * swing));
    std::printf("amplitude after 4 swings: %.4f\n", late / early);
    EXPECT_GT(late / early, 0.9);
    EXPECT_LT(late / early, 1.02);
}

}  // namespace
}  // namespace lamella::melp
