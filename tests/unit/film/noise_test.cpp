#include "lamella/film/noise.h"

#include "lamella/film/surfactant.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella::film {
namespace {

TEST(Noise, IsAFunctionOfThePlaceAndTheSeed) {
    const Vec3 x{{0.12, -3.4, 7.7}};
    EXPECT_EQ(gradient_noise(x, 5, 3), gradient_noise(x, 5, 3));
    EXPECT_NE(gradient_noise(x, 5, 3), gradient_noise(x, 6, 3));
}

TEST(Noise, IsSmoothHasNoMeanAndStaysInItsBounds) {
    const auto noise = [](const Vec3& x) { return gradient_noise(x, 1); };
    double sum = 0.0, square = 0.0;
    constexpr int kSide = 30;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j)
            for (int k = 0; k < kSide; ++k) {
                const Vec3 x{{0.37 * i - 3.0, 0.41 * j - 5.0, 0.43 * k}};
                const double value = noise(x);
                EXPECT_LE(std::abs(value), 1.0);
                EXPECT_LT(std::abs(noise(x + Vec3{{1e-6, 0, 0}}) - value), 1e-5);
                sum += value;
                square += value * value;
            }
    constexpr double kCount = kSide * kSide * kSide;
    // About (11 / 1)^3 independent cells: five standard errors of the mean.
    EXPECT_LT(std::abs(sum / kCount), 5.0 * std::sqrt(square / kCount / 1331.0));
    EXPECT_GT(square / kCount, 0.01);
    EXPECT_EQ(noise({{2.0, -1.0, 5.0}}), 0.0);  // gradient noise vanishes at the corners of its grid
}

TEST(Noise, AddsOctavesOfHalfTheLength) {
    const Vec3 middle{{0.5, 0.5, 0.5}}, elsewhere{{0.3, 0.2, 0.6}};  // the middle is a corner of the second octave
    EXPECT_EQ(gradient_noise(middle, 1, 1), gradient_noise(middle, 1, 2));
    EXPECT_NE(gradient_noise(elsewhere, 1, 1), gradient_noise(elsewhere, 1, 2));
}

TEST(SurfactantLaw, TakesRTPerConcentrationFromTheTension) {
    const SurfactantLaw law{.reference_tension = 0.0725, .reference_concentration = 1e-7, .temperature = 298.15};
    EXPECT_EQ(law.tension(1e-7), 0.0725);
    EXPECT_NEAR(law.tension(0.0) - 0.0725, 2.479e-4, 1e-7);  // [method sheet 12]: R T Gamma = 2.48e-4 N/m
}

}  // namespace
}  // namespace lamella::film
