#include "lamella/core/fixed_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lamella/core/random.h"

namespace lamella {
namespace {

std::vector<double> terms(std::size_t count) {
    std::vector<double> list(count);
    for (std::size_t i = 0; i < count; ++i) {
        const RandomBits bits = random_bits(3, RandomStream::kBubbleRadius, 0, i);
        list[i] = (uniform01(bits) - 0.3) * std::pow(10.0, 12.0 * uniform01(bits, 1) - 9.0);
    }
    return list;
}

TEST(FixedSum, DoesNotDependOnTheOrder) {
    auto list = terms(5000);
    double bound = 0.0;
    for (const double t : list) bound += std::abs(t);
    FixedSum forward(bound);
    for (const double t : list) forward.add(t);
    std::reverse(list.begin(), list.end());
    FixedSum backward(bound);
    backward.add(list.data(), 2000);
    FixedSum rest(bound);
    rest.add(list.data() + 2000, 3000);
    backward += rest;
    EXPECT_EQ(forward.value(), backward.value());
    EXPECT_EQ(forward.high(), backward.high());
    EXPECT_EQ(forward.low(), backward.low());
}

TEST(FixedSum, IsMoreAccurateThanDoubles) {
    const auto list = terms(100'000);
    long double exact = 0.0L;
    double bound = 0.0;
    for (const double t : list) {
        exact += t;
        bound += std::abs(t);
    }
    FixedSum sum(bound);
    sum.add(list.data(), list.size());
    EXPECT_NEAR(sum.value(), static_cast<double>(exact), 1e-16 * bound);
    EXPECT_NEAR(exact_sum(list.size(), [&](std::size_t i) { return list[i]; }), sum.value(), 1e-16 * bound);
}

TEST(FixedSum, KeepsCancellationExact) {
    FixedSum sum(1e6);
    for (int i = 0; i < 1000; ++i) {
        sum.add(1.0 / 3.0 + i);
        sum.add(-1.0 / 3.0 - i);
    }
    sum.add(1e-12);
    EXPECT_NEAR(sum.value(), 1e-12, 1e-20);
}

TEST(FixedSum, IgnoresVacantSlotsToTheLastBit) {
    auto list = terms(1000);
    const auto sum = [&] { return exact_sum(list.size(), [&](std::size_t i) { return list[i]; }); };
    const double before = sum();
    list.insert(list.begin() + 400, 3000, 0.0);
    EXPECT_EQ(sum(), before);
}

TEST(FixedSum, OfNothingIsZero) {
    EXPECT_EQ(FixedSum().value(), 0.0);
    EXPECT_EQ(exact_sum(0, [](std::size_t) { return 1.0; }), 0.0);
    EXPECT_EQ(exact_sum(10, [](std::size_t) { return 0.0; }), 0.0);
}

}  // namespace
}  // namespace lamella
