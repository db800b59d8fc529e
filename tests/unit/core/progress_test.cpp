#include "lamella/core/progress.h"

#include <gtest/gtest.h>

#include <limits>

namespace lamella {
namespace {

TEST(ProgressEstimate, KnowsNothingBeforeTwoReports) {
    ProgressEstimate estimate;
    EXPECT_FALSE(estimate.rate());
    estimate.update(1.0, 0.1);
    EXPECT_FALSE(estimate.rate());
    EXPECT_FALSE(estimate.seconds_left());
    EXPECT_EQ(estimate.fraction(), 0.1);
}

TEST(ProgressEstimate, KnowsNothingWhileNothingMoves) {
    ProgressEstimate estimate;
    estimate.update(0.0, 0.2);
    estimate.update(10.0, 0.2);
    EXPECT_FALSE(estimate.seconds_left());
}

TEST(ProgressEstimate, IsExactAtConstantSpeed) {
    ProgressEstimate estimate;
    for (int i = 0; i <= 40; ++i) estimate.update(0.5 * i, 0.02 * i);
    EXPECT_NEAR(*estimate.rate(), 0.04, 1e-12);
    EXPECT_NEAR(*estimate.seconds_left(), 0.2 / 0.04, 1e-9);
}

TEST(ProgressEstimate, FollowsAChangeOfSpeed) {
    ProgressEstimate estimate;
    double fraction = 0.0;
    for (int second = 0; second <= 60; ++second) estimate.update(second, fraction = 0.001 * second);
    for (int second = 61; second <= 100; ++second) estimate.update(second, fraction += 0.01);
    // The last third (33 s) lies in the fast part; one sample at its edge may be older by the spacing of samples.
    EXPECT_NEAR(*estimate.rate(), 0.01, 0.0005);
}

TEST(ProgressEstimate, StartsAfreshWhenTheFractionFallsBack) {
    ProgressEstimate estimate;
    estimate.update(0.0, 0.0);
    estimate.update(10.0, 0.9);
    estimate.update(11.0, 0.1);
    EXPECT_FALSE(estimate.rate());
    estimate.update(12.0, 0.2);
    EXPECT_NEAR(*estimate.rate(), 0.1, 1e-12);
}

TEST(ProgressEstimate, IsNotSwampedByAMillionReports) {
    ProgressEstimate estimate;
    for (int i = 0; i < 1000000; ++i) estimate.update(1e-4 * i, 1e-6 * i);
    EXPECT_NEAR(*estimate.rate(), 0.01, 1e-4);
}

TEST(DurationText, ReadsLikeSpeech) {
    EXPECT_EQ(duration_text(0.0), "0.0 s");
    EXPECT_EQ(duration_text(3.14), "3.1 s");
    EXPECT_EQ(duration_text(59.4), "59 s");
    EXPECT_EQ(duration_text(59.6), "1 min 0 s");
    EXPECT_EQ(duration_text(200.0), "3 min 20 s");
    EXPECT_EQ(duration_text(7500.0), "2 h 5 min");
    EXPECT_EQ(duration_text(356400.0), "4 d 3 h");
    EXPECT_EQ(duration_text(std::numeric_limits<double>::infinity()), "?");
}

}  // namespace
}  // namespace lamella
