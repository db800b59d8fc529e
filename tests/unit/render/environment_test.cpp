#include "lamella/render/environment.h"

#include "lamella/core/error.h"
#include "lamella/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace lamella::render {
namespace {

Vec3 direction(int i) {
    const Vec2 u = uniform_vector<2>(random_bits(7, RandomStream::kPicture, 0, static_cast<std::uint64_t>(i)));
    const double z = 2.0 * u[0] - 1.0, ring = std::sqrt(1.0 - z * z), around = 2.0 * std::numbers::pi * u[1];
    return {{ring * std::cos(around), ring * std::sin(around), z}};
}

TEST(Environment, DrawsDirectionsWithTheDensityThatItSays) {
    for (const std::string& name : Environment::names()) {
        const Environment environment(name);
        constexpr int kDraws = 20'000;
        double sphere = 0.0, square = 0.0;
        for (int i = 0; i < kDraws; ++i) {
            const Vec2 u = uniform_vector<2>(random_bits(3, RandomStream::kPicture, 0, static_cast<std::uint64_t>(i)));
            const LightSample sample = environment.sample(u[0], u[1]);
            EXPECT_NEAR(norm(sample.direction), 1.0, 1e-12);
            if (i < 500) {
                EXPECT_NEAR(environment.density(sample.direction) / sample.density, 1.0, 1e-6) << name;
            }
            sphere += 1.0 / sample.density / kDraws;
            square += 1.0 / (sample.density * sample.density) / kDraws;
        }
        const double error = std::sqrt((square - sphere * sphere) / kDraws);
        EXPECT_NEAR(sphere, 4.0 * std::numbers::pi, 5.0 * error) << name;
    }
}

TEST(Environment, KnowsWhatMatteSurfacesThrowBack) {
    EXPECT_NEAR(Environment("gray").matte({{0.0, 0.6, 0.8}})[1], 1.0, 2e-3);
    for (const std::string& name : Environment::names()) {
        const Environment environment(name);
        for (const Vec3& normal : {Vec3{{0.0, 0.0, 1.0}}, Vec3{{0.36, -0.48, 0.8}}, Vec3{{-1.0, 0.0, 0.0}}}) {
            constexpr int kDraws = 40'000;
            double sum = 0.0, square = 0.0;
            for (int i = 0; i < kDraws; ++i) {
                const Vec3 d = direction(i);
                const double value = 4.0 * std::max(0.0, dot(d, normal)) * environment.light(d)[1];
                sum += value / kDraws;
                square += value * value / kDraws;
            }
            const double error = std::sqrt((square - sum * sum) / kDraws);
            EXPECT_NEAR(environment.matte(normal)[1], sum, 5.0 * error + 0.01 * sum) << name;
            EXPECT_LE(optics::luminance(environment.matte(normal)), environment.brightest_matte() * (1.0 + 1e-12));
        }
    }
}

/// A Radiance file without compression whose pixels are (1, 2, 4) times `scale(x, y)`, a power of two.
std::filesystem::path light_file(int width, int height, int (*power)(int x, int y)) {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "lamella_environment_test.hdr";
    std::ofstream out(path, std::ios::binary);
    out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << height << " +X " << width << "\n";
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const char pixel[4] = {32, 64, static_cast<char>(128), static_cast<char>(128 + 3 + power(x, y))};
            out.write(pixel, 4);
        }
    return path;
}

TEST(Environment, CanBeAPictureOfLight) {
    const auto path = light_file(8, 4, [](int x, int y) { return y == 0 ? 3 : x == 4 ? 1 : 0; });
    const Environment environment(path.string());
    const Vec3 up{{0.0, 0.0, 1.0}}, away{{-0.8, 0.6, 0.0}};
    EXPECT_NEAR(environment.light(up)[1], 16.0, 0.2);  // the upper row: 8 times (1, 2, 4); a pixel's mantissa is 8 bits
    EXPECT_NEAR(environment.light(away)[2], 4.0, 0.05);
    // Column 4 of 8 lies just right of the middle, which is azimuth 0; to the right is clockwise, seen from above.
    const double azimuth = -22.5 * std::numbers::pi / 180.0;
    EXPECT_NEAR(environment.light(
                    {{std::cos(azimuth) * std::cos(0.39), std::sin(azimuth) * std::cos(0.39), -std::sin(0.39)}})[0],
                2.0, 0.05);
    std::filesystem::remove(path);
    EXPECT_THROW(Environment("there/is/no/such.hdr"), IoError);
    EXPECT_THROW(Environment("beach"), InputError);
}

}  // namespace
}  // namespace lamella::render
