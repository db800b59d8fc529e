#include "lamella/run/schedule.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace lamella::run {
namespace {

/// All output times up to the end (or `most` of them), found as the loop finds them.
std::vector<OutputTime> all_times(const Schedule& schedule, std::size_t most = 100000) {
    std::vector<OutputTime> times;
    double time = 0.0;
    while (times.size() < most) {
        const OutputTime next = schedule.next(time);
        if (!is_after(next.time, time)) break;
        times.push_back(next);
        time = next.time;
    }
    return times;
}

TEST(Schedule, GivesFramesAtMultiplesComputedFromTheirNumber) {
    const auto times = all_times(Schedule({.end = 1000.0, .frame_rate = 3.0}));
    ASSERT_EQ(times.size(), 3000u);
    for (std::size_t k = 0; k < times.size(); ++k) {
        EXPECT_EQ(times[k].time, static_cast<double>(k + 1) / 3.0);  // not added up: no drift
        EXPECT_TRUE(times[k].frame);
    }
}

TEST(Schedule, MergesRowsAndFramesThatFallTogether) {
    const auto times = all_times(Schedule({.end = 7.0, .frame_rate = 0.1 * 10.0, .series_rate = 10.0}));
    ASSERT_EQ(times.size(), 70u);
    for (std::size_t k = 0; k < times.size(); ++k) {
        EXPECT_NEAR(times[k].time, 0.1 * static_cast<double>(k + 1), 1e-12);
        EXPECT_EQ(times[k].frame, (k + 1) % 10 == 0) << times[k].time;
    }
}

TEST(Schedule, SpacesLogarithmicRowsEvenlyPerDecade) {
    const auto times =
        all_times(Schedule({.end = 100.0, .frame_rate = 0.0, .series_per_decade = 5.0, .log_start = 0.01}));
    ASSERT_EQ(times.size(), 21u);
    for (std::size_t k = 0; k < times.size(); ++k)
        EXPECT_NEAR(times[k].time, 0.01 * std::pow(10.0, static_cast<double>(k) / 5.0), 1e-12 * times[k].time);
    EXPECT_EQ(times.back().time, 100.0);
    EXPECT_TRUE(times.back().frame);
    EXPECT_FALSE(times.front().frame);
}

TEST(Schedule, EndsWithAFrameWhereverTheEndLies) {
    const auto times = all_times(Schedule({.end = 2.5, .frame_rate = 1.0}));
    ASSERT_EQ(times.size(), 3u);
    EXPECT_EQ(times[2].time, 2.5);
    EXPECT_TRUE(times[2].frame);
}

TEST(Schedule, HasNoEndWithoutOne) {
    const Schedule schedule({.end = 0.0, .frame_rate = 0.0});
    EXPECT_EQ(schedule.end(), std::numeric_limits<double>::infinity());
    EXPECT_EQ(schedule.next(5.0).time, std::numeric_limits<double>::infinity());
    EXPECT_EQ(all_times(Schedule({.end = 0.0, .frame_rate = 1.0}), 10).back().time, 10.0);
}

TEST(Schedule, FindsTheSameTimesFromAnyPoint) {
    const Schedule schedule(
        {.end = 50.0, .frame_rate = 0.7, .series_rate = 2.1, .series_per_decade = 7.0, .log_start = 0.03});
    const auto times = all_times(schedule);
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
        const OutputTime next = schedule.next(times[k].time);
        EXPECT_EQ(next.time, times[k + 1].time);
        EXPECT_EQ(next.frame, times[k + 1].frame);
        EXPECT_GT(next.time, times[k].time);
    }
}

TEST(Schedule, UntilReplacesTheEnd) {
    EXPECT_EQ(Schedule({.end = 5.0}, 2.0).end(), 2.0);
    EXPECT_EQ(Schedule({.end = 5.0}, 20.0).end(), 20.0);
    EXPECT_THROW(Schedule({.end = 5.0}, 0.0), InputError);
    EXPECT_THROW(Schedule({.end = 5.0}, std::nan("")), InputError);
}

TEST(Schedule, RefusesAbsurdRates) {
    EXPECT_THROW(Schedule({.end = 1.0, .frame_rate = 1e300}), InputError);
    EXPECT_THROW(Schedule({.end = 1.0, .series_rate = 1e10}), InputError);
    EXPECT_GT(Schedule({.end = 0.0, .frame_rate = 1e300}).next(0.5).time, 0.5);  // nobody knows how long it will run
}

}  // namespace
}  // namespace lamella::run
