#include "lamella/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace lamella {
namespace {

constexpr int kDraws = 100'000;
// A mean of kDraws values of variance v lies within 5 sqrt(v / kDraws) of the truth; these draws never change, so a
// test that passes once passes always.
double five_standard_errors(double variance) { return 5.0 * std::sqrt(variance / kDraws); }

RandomBits draw_bits(int i) { return random_bits(7, RandomStream::kBubbleRadius, 0, static_cast<std::uint64_t>(i)); }

// The three vectors that [Salmon11] publish for Philox4x32-10, as counter, key, result. The counter words are put
// together from the arguments as random_bits documents: item, step and draw and stream.
TEST(RandomBits, MatchesThePublishedVectors) {
    // Counter 0 0 0 0, key 0 0.
    EXPECT_EQ(random_bits(0, RandomStream{0}, 0, 0), (RandomBits{{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}}));
    // Counter and key all ones.
    EXPECT_EQ(random_bits(~std::uint64_t{0}, RandomStream{0xffff}, 0xffffffffffULL, ~std::uint64_t{0}, 0xff),
              (RandomBits{{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}}));
    // Digits of pi: counter 243f6a88 85a308d3 13198a2e 03707344, key a4093822 299f31d0.
    EXPECT_EQ(random_bits(0x299f31d0a4093822ULL, RandomStream{0x7344}, 0x0313198a2eULL, 0x85a308d3243f6a88ULL, 0x70),
              (RandomBits{{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}}));
}

TEST(RandomBits, ChangesWithEveryArgument) {
    const RandomBits base = random_bits(1, RandomStream::kBubbleRadius, 2, 3, 4);
    EXPECT_EQ(base, random_bits(1, RandomStream::kBubbleRadius, 2, 3, 4));
    EXPECT_NE(base, random_bits(2, RandomStream::kBubbleRadius, 2, 3, 4));
    EXPECT_NE(base, random_bits(1, RandomStream::kBubbleJitter, 2, 3, 4));
    EXPECT_NE(base, random_bits(1, RandomStream::kBubbleRadius, 3, 3, 4));
    EXPECT_NE(base, random_bits(1, RandomStream::kBubbleRadius, 2, 4, 4));
    EXPECT_NE(base, random_bits(1, RandomStream::kBubbleRadius, 2, 3, 5));
    // Bits beyond the first 32 of a wide argument count too.
    EXPECT_NE(base, random_bits(1, RandomStream::kBubbleRadius, 2, 3 + (std::uint64_t{1} << 32), 4));
    EXPECT_NE(base, random_bits(1, RandomStream::kBubbleRadius, 2 + (std::uint64_t{1} << 32), 3, 4));
    EXPECT_NE(base, random_bits(1 + (std::uint64_t{1} << 32), RandomStream::kBubbleRadius, 2, 3, 4));
}

TEST(RandomBits, DoesNotRepeatOverItemsAndStreams) {
    std::set<std::uint64_t> seen;
    for (const RandomStream stream : {RandomStream::kBubblePosition, RandomStream::kBubbleJitter})
        for (std::uint64_t item = 0; item < 10'000; ++item) seen.insert(random_bits(1, stream, 0, item).half(0));
    EXPECT_EQ(seen.size(), 20'000U);  // a chance of 1e-11 to fail for true random bits
}

TEST(RandomBits, IsUncorrelatedBetweenNeighborsOfEveryArgument) {
    using Shift = RandomBits (*)(std::uint64_t);
    const Shift neighbors[] = {
        [](std::uint64_t i) { return random_bits(8, RandomStream::kBubbleRadius, 0, i); },
        [](std::uint64_t i) { return random_bits(7, RandomStream::kBubbleJitter, 0, i); },
        [](std::uint64_t i) { return random_bits(7, RandomStream::kBubbleRadius, 1, i); },
        [](std::uint64_t i) { return random_bits(7, RandomStream::kBubbleRadius, 0, i + 1); },
        [](std::uint64_t i) { return random_bits(7, RandomStream::kBubbleRadius, 0, i, 1); },
    };
    for (const Shift neighbor : neighbors) {
        double covariance = 0.0;
        for (int i = 0; i < kDraws; ++i)
            covariance += (uniform01(draw_bits(i)) - 0.5) * (uniform01(neighbor(static_cast<std::uint64_t>(i))) - 0.5);
        EXPECT_NEAR(covariance / kDraws, 0.0, five_standard_errors(1.0 / 144.0));
    }
}

TEST(Uniform01, StaysBelowOneAndKeeps53Bits) {
    const RandomBits zeros{};
    const RandomBits ones{{~0U, ~0U, ~0U, ~0U}};
    EXPECT_EQ(uniform01(zeros), 0.0);
    EXPECT_EQ(uniform01(ones, 0), 1.0 - 0x1.0p-53);
    EXPECT_EQ(uniform01(ones, 1), 1.0 - 0x1.0p-53);
    EXPECT_EQ(uniform01(RandomBits{{0, 0x80000000U, 0, 0}}, 0), 0.5);
    EXPECT_EQ(uniform01(RandomBits{{0, 0, 0, 0x80000000U}}, 1), 0.5);
    EXPECT_EQ(uniform01(RandomBits{{1U << 11, 0, 0, 0}}), 0x1.0p-53);
}

TEST(Uniform01, HasTheMomentsOfTheUniformDistribution) {
    for (const std::size_t k : {0U, 1U}) {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < kDraws; ++i) {
            const double u = uniform01(draw_bits(i), k);
            sum += u;
            squares += u * u;
        }
        EXPECT_NEAR(sum / kDraws, 0.5, five_standard_errors(1.0 / 12.0));
        EXPECT_NEAR(squares / kDraws, 1.0 / 3.0, five_standard_errors(4.0 / 45.0));
    }
}

TEST(UniformVector, UsesEveryBitOnce) {
    // Setting one bit moves exactly one coordinate, except the bits that the resolution leaves out.
    int used_2d = 0, used_3d = 0;
    for (std::size_t bit = 0; bit < 128; ++bit) {
        RandomBits bits;
        bits.word[bit / 32] = 1U << (bit % 32);
        int moved = 0;
        for (std::size_t k = 0; k < 2; ++k) moved += uniform_vector<2>(bits)[k] > 0.0;
        EXPECT_LE(moved, 1);
        used_2d += moved;
        moved = 0;
        for (std::size_t k = 0; k < 3; ++k) moved += uniform_vector<3>(bits)[k] > 0.0;
        EXPECT_LE(moved, 1);
        used_3d += moved;
    }
    EXPECT_EQ(used_2d, 2 * 53);
    EXPECT_EQ(used_3d, 3 * 42);
    const Vec3 largest = uniform_vector<3>(RandomBits{{~0U, ~0U, ~0U, ~0U}});
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(largest[k], 1.0 - 0x1.0p-42);
}

TEST(UniformVector, HasIndependentUniformCoordinates) {
    Vec3 sum, products;
    for (int i = 0; i < kDraws; ++i) {
        const Vec3 u = uniform_vector<3>(draw_bits(i));
        sum += u;
        for (std::size_t k = 0; k < 3; ++k) products[k] += (u[k] - 0.5) * (u[(k + 1) % 3] - 0.5);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(sum[k] / kDraws, 0.5, five_standard_errors(1.0 / 12.0));
        EXPECT_NEAR(products[k] / kDraws, 0.0, five_standard_errors(1.0 / 144.0));
    }
}

TEST(Normal, HasTheMomentsOfTheNormalDistribution) {
    double sum = 0.0, squares = 0.0, cubes = 0.0, fourths = 0.0, product = 0.0;
    for (int i = 0; i < kDraws; ++i) {
        const Vec2 pair = normal_pair(draw_bits(i));
        const double x = normal(draw_bits(i));
        EXPECT_EQ(x, pair[0]);
        sum += x;
        squares += x * x;
        cubes += x * x * x;
        fourths += x * x * x * x;
        product += pair[0] * pair[1];
    }
    // Variances of x, x^2, x^3, x^4, xy: 1, 2, 15, 96, 1.
    EXPECT_NEAR(sum / kDraws, 0.0, five_standard_errors(1.0));
    EXPECT_NEAR(squares / kDraws, 1.0, five_standard_errors(2.0));
    EXPECT_NEAR(cubes / kDraws, 0.0, five_standard_errors(15.0));
    EXPECT_NEAR(fourths / kDraws, 3.0, five_standard_errors(96.0));
    EXPECT_NEAR(product / kDraws, 0.0, five_standard_errors(1.0));
}

TEST(Normal, IsFiniteAtTheEndsOfTheUniformRange) {
    for (const RandomBits& bits : {RandomBits{}, RandomBits{{~0U, ~0U, ~0U, ~0U}}}) {
        const Vec2 pair = normal_pair(bits);
        EXPECT_LT(norm(pair), 8.6);
    }
}

TEST(Lognormal, HasTheGivenMeanAndDeviation) {
    const double mean = 2.0, deviation = 0.6;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < kDraws; ++i) {
        const double x = lognormal(draw_bits(i), mean, deviation);
        EXPECT_GT(x, 0.0);
        sum += x;
        squares += (x - mean) * (x - mean);
    }
    EXPECT_NEAR(sum / kDraws, mean, five_standard_errors(deviation * deviation));
    // Fourth central moment / variance^2 of this distribution is 4.57, so Var((x - mean)^2) = 3.57 * 0.6^4.
    EXPECT_NEAR(squares / kDraws, deviation * deviation, five_standard_errors(3.57 * std::pow(deviation, 4)));
    EXPECT_EQ(lognormal(draw_bits(0), mean, 0.0), mean);
}

template <int D>
void expect_isotropic() {
    Vec<D> sum, squares;
    double cross_term = 0.0;
    for (int i = 0; i < kDraws; ++i) {
        const Vec<D> e = unit_vector<D>(draw_bits(i));
        EXPECT_NEAR(norm(e), 1.0, 1e-15);
        sum += e;
        for (std::size_t k = 0; k < D; ++k) squares[k] += e[k] * e[k];
        cross_term += e[0] * e[1];
    }
    // <e_k^2> = 1/D; the variances of e_k, e_k^2 and e_0 e_1 are at most 1/2, 1/8 and 1/8.
    for (std::size_t k = 0; k < D; ++k) {
        EXPECT_NEAR(sum[k] / kDraws, 0.0, five_standard_errors(0.5));
        EXPECT_NEAR(squares[k] / kDraws, 1.0 / D, five_standard_errors(0.125));
    }
    EXPECT_NEAR(cross_term / kDraws, 0.0, five_standard_errors(0.125));
}

TEST(UnitVector, IsIsotropicInTwoDimensions) { expect_isotropic<2>(); }
TEST(UnitVector, IsIsotropicInThreeDimensions) { expect_isotropic<3>(); }

}  // namespace
}  // namespace lamella
