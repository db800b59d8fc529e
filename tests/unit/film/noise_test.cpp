#include "lamella/film/noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella::film {
namespace {

TEST(GradientNoise, IsZeroOnTheGridSmoothAndBounded) {
    double mean = 0.0, square = 0.0;
    int count = 0;
    for (double x = -3.05; x < 3.0; x += 0.13)
        for (double y = -3.05; y < 3.0; y += 0.13) {
            const Vec3 at{{x, y, 0.37 * x - 0.21 * y}};
            const double value = gradient_noise(at, 5);
            EXPECT_LE(std::abs(value), 1.0);
            // Slopes of the grid are sqrt(2), those of the blend below 2 in each direction: a step of 1e-6 moves it less than 1e-5.
            EXPECT_NEAR(gradient_noise(at + Vec3{{1e-6, 0, 0}}, 5), value, 1e-5);
            mean += value;
            square += value * value;
            ++count;
        }
    EXPECT_LT(std::abs(mean / count), 0.05);
    EXPECT_GT(std::sqrt(square / count), 0.15);
    for (int i = -2; i < 3; ++i) EXPECT_EQ(gradient_noise(Vec3{{1.0 * i, 2.0 - i, 3.0}}, 5), 0.0);
}

TEST(GradientNoise, DiffersBySeedAndAddsOctaves) {
    const Vec3 at{{0.3, 0.4, 0.7}};
    EXPECT_NE(gradient_noise(at, 1), gradient_noise(at, 2));
    EXPECT_EQ(gradient_noise(at, 1, 1), gradient_noise(at, 1));
    EXPECT_EQ(gradient_noise(at, 1, 2), gradient_noise(at, 1) + 0.5 * gradient_noise(2.0 * at, 2));
}

}  // namespace
}  // namespace lamella::film
