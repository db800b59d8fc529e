#include "lamella/core/parallel.h"
#include "lamella/core/parallel_sort.h"
#include "lamella/core/vec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace lamella {
namespace {

// Around the edges of one and of several blocks.
const std::vector<std::size_t> kCounts = {
    0, 1, 2, kParallelBlock - 1, kParallelBlock, kParallelBlock + 1, 5 * kParallelBlock, 5 * kParallelBlock + 17};

/// Terms of very different size, so that another order of addition gives other bits.
double uneven_term(std::size_t i) {
    const auto x = static_cast<double>(i);
    return std::sin(x) * std::pow(10.0, static_cast<double>(i % 31) - 15.0) + 1.0 / (x + 1.0);
}

TEST(ThreadLimit, HoldsForItsLifetimeAndNests) {
    const int before = thread_count();
    {
        const ThreadLimit two(2);
        EXPECT_EQ(thread_count(), 2);
        {
            const ThreadLimit one(1);
            EXPECT_EQ(thread_count(), 1);
        }
        EXPECT_EQ(thread_count(), 2);
    }
    EXPECT_EQ(thread_count(), before);
}

TEST(ThreadLimit, ZeroMeansEveryCore) {
    const ThreadLimit all(0);
    EXPECT_EQ(thread_count(), static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
}

TEST(ThreadLimit, OneKeepsTheWorkOnTheCallingThread) {
    const ThreadLimit one(1);
    std::set<std::thread::id> threads;  // unguarded on purpose: there must be no other thread
    parallel_for(20 * kParallelBlock, [&](std::size_t i) {
        if (i % kParallelBlock == 0) threads.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

TEST(ParallelFor, VisitsEveryIndexOnce) {
    const ThreadLimit two(2);
    for (const std::size_t count : kCounts) {
        std::vector<int> visits(count, 0);
        parallel_for(count, [&](std::size_t i) { ++visits[i]; });
        EXPECT_EQ(visits, std::vector<int>(count, 1)) << count;
    }
}

TEST(ParallelFor, WorksOnTwoThreadsAtOnce) {
    if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
    const ThreadLimit two(2);
    // Two blocks that wait for each other meet only if they run at the same time.
    std::atomic<int> arrived = 0, met = 0;
    parallel_blocks(2, 1, [&](std::size_t, std::size_t) {
        ++arrived;
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (arrived < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
        if (std::chrono::steady_clock::now() < deadline) ++met;
    });
    EXPECT_EQ(met, 2);
}

TEST(ParallelFor, SeesWhatWasWrittenBeforeAndShowsWhatItWrote) {
    const ThreadLimit two(2);
    std::vector<std::uint64_t> values(10 * kParallelBlock, 1);
    for (int round = 0; round < 20; ++round) {
        for (auto& value : values) value *= 3;                                // this thread
        parallel_for(values.size(), [&](std::size_t i) { values[i] += i; });  // any thread
        parallel_for(values.size(), [&](std::size_t i) { values[i] ^= values[i] >> 7; });
    }
    std::vector<std::uint64_t> expected(values.size(), 1);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        for (int round = 0; round < 20; ++round) {
            expected[i] = expected[i] * 3 + i;
            expected[i] ^= expected[i] >> 7;
        }
    }
    EXPECT_EQ(values, expected);
}

TEST(ParallelFor, NestsWithoutLosingWork) {
    const ThreadLimit two(2);
    constexpr std::size_t kOuter = 8;
    const std::size_t inner = 3 * kParallelBlock;
    std::vector<double> sums(kOuter, 0.0);
    parallel_blocks(kOuter, 1, [&](std::size_t outer, std::size_t) {
        sums[outer] = parallel_sum(inner, [](std::size_t i) { return static_cast<double>(i); });
    });
    const double expected = 0.5 * static_cast<double>(inner) * static_cast<double>(inner - 1);
    EXPECT_EQ(sums, std::vector<double>(kOuter, expected));
}

TEST(ParallelFor, PassesExceptionsToTheCaller) {
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        for (const std::size_t count : {std::size_t{10}, 50 * kParallelBlock}) {  // one block and many
            const auto fail_at_seven = [](std::size_t i) {
                if (i == 7) throw std::runtime_error("seven");
            };
            try {
                parallel_for(count, fail_at_seven);
                ADD_FAILURE() << "no exception, " << count << " items";
            } catch (const std::runtime_error& error) {
                EXPECT_STREQ(error.what(), "seven");
            }
        }
        // And the next loop works as ever.
        EXPECT_EQ(parallel_sum(kParallelBlock * 3, [](std::size_t) { return 1.0; }), 3.0 * kParallelBlock);
    }
}

TEST(ParallelFor, AcceptsABodyThatCannotBeCopied) {
    std::vector<int> seen(3, 0);
    auto body = [&seen, token = std::make_unique<int>(5)](std::size_t i) { seen[i] = *token; };
    parallel_for(seen.size(), std::move(body));
    EXPECT_EQ(seen, std::vector<int>(3, 5));
}

TEST(ParallelBlocks, CoversTheRangeWithBlocksThatIgnoreTheThreadCount) {
    for (const std::size_t block : {std::size_t{1}, std::size_t{7}, std::size_t{1000}}) {
        for (const std::size_t count :
             {std::size_t{0}, std::size_t{1}, std::size_t{999}, std::size_t{1000}, std::size_t{1001}}) {
            std::set<std::pair<std::size_t, std::size_t>> expected;
            for (std::size_t begin = 0; begin < count; begin += block)
                expected.emplace(begin, std::min(count, begin + block));
            for (const int threads : {1, 2}) {
                const ThreadLimit limit(threads);
                std::mutex guard;
                std::set<std::pair<std::size_t, std::size_t>> ranges;
                parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
                    const std::lock_guard lock(guard);
                    EXPECT_TRUE(ranges.emplace(begin, end).second);
                });
                EXPECT_EQ(ranges, expected) << count << " items in blocks of " << block;
            }
        }
    }
}

TEST(ParallelSum, HasTheSameBitsOnAnyNumberOfThreads) {
    for (const std::size_t count : kCounts) {
        std::uint64_t reference = 0;
        for (const int threads : {1, 2, 3, 8}) {
            const ThreadLimit limit(threads);
            for (int repeat = 0; repeat < 5; ++repeat) {
                const auto bits = std::bit_cast<std::uint64_t>(parallel_sum(count, uneven_term));
                if (threads == 1 && repeat == 0) reference = bits;
                EXPECT_EQ(bits, reference) << count << " items on " << threads << " threads";
            }
        }
    }
}

TEST(ParallelSum, AddsInTheOrderOfTheIndices) {
    // One block: plain left-to-right addition, to the bit.
    double expected = 0.0;
    for (std::size_t i = 0; i < kParallelBlock; ++i) expected += uneven_term(i);
    EXPECT_EQ(parallel_sum(kParallelBlock, uneven_term), expected);
    EXPECT_EQ(parallel_sum(0, uneven_term), 0.0);
    const Vec2 both = parallel_sum(3 * kParallelBlock, [](std::size_t i) { return Vec2{{uneven_term(i), 1.0}}; });
    EXPECT_EQ(both[0], parallel_sum(3 * kParallelBlock, uneven_term));
    EXPECT_EQ(both[1], 3.0 * kParallelBlock);
}

TEST(ParallelReduce, CombinesInOrder) {
    const ThreadLimit two(2);
    const std::size_t count = 5 * kParallelBlock + 3;
    using List = std::vector<std::size_t>;
    const List begins = parallel_reduce(
        count, List{}, [](std::size_t begin, std::size_t) { return List{begin}; },
        [](List a, const List& b) {
            a.insert(a.end(), b.begin(), b.end());
            return a;
        });
    EXPECT_EQ(begins, (List{0, kParallelBlock, 2 * kParallelBlock, 3 * kParallelBlock, 4 * kParallelBlock,
                            5 * kParallelBlock}));
}

TEST(ParallelMax, FindsTheLargestWhereverItIs) {
    const ThreadLimit two(2);
    for (const std::size_t count : kCounts) {
        for (const std::size_t where : {std::size_t{0}, count / 2, count - 1}) {
            if (count == 0) continue;
            const auto term = [&](std::size_t i) { return i == where ? -1.0 : -2.0; };
            EXPECT_EQ(parallel_max(count, -std::numeric_limits<double>::infinity(), term), -1.0);
        }
    }
    EXPECT_EQ(parallel_max(0, 4.0, [](std::size_t) { return 9.0; }), 4.0);
    EXPECT_EQ(parallel_max(10, 4.0, [](std::size_t) { return 1.0; }), 4.0);
}

TEST(ParallelSort, SortsAsTheStandardLibraryDoes) {
    const ThreadLimit two(2);
    for (const std::size_t count : {0UL, 1UL, 2UL, 8191UL, 8192UL, 8193UL, 16384UL, 40000UL, 100001UL}) {
        std::vector<std::pair<int, std::size_t>> items(count);
        for (std::size_t i = 0; i < count; ++i) items[i] = {static_cast<int>(1e4 * std::sin(3.7 * static_cast<double>(i))), i};
        auto expected = items;
        std::sort(expected.begin(), expected.end());
        parallel_sort(items);
        EXPECT_EQ(items, expected) << count;
    }
}

}  // namespace
}  // namespace lamella
