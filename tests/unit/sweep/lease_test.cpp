#include "lamella/sweep/lease.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace lamella::sweep {
namespace {

namespace fs = std::filesystem;

class LeaseTest : public testing::Test {
protected:
    LeaseTest() {
        std::string name = (fs::temp_directory_path() / "lamella_lease_XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
        file_ = folder_ / "task";
    }
    ~LeaseTest() override { fs::remove_all(folder_); }

    /// What a process on another machine left, heard of `age` seconds ago.
    void leave(int attempt, double age) const {
        std::ofstream(file_) << "elsewhere.example 1 " << attempt << "\n";
        timespec now{};
        ::clock_gettime(CLOCK_REALTIME, &now);
        now.tv_sec -= static_cast<time_t>(age);
        const std::array<timespec, 2> times{now, now};
        ASSERT_EQ(::utimensat(AT_FDCWD, file_.c_str(), times.data(), 0), 0);
    }

    fs::path folder_, file_;
};

TEST_F(LeaseTest, IsHeldByOneAndGivenBack) {
    EXPECT_EQ(lease_state(file_), LeaseState::kFree);
    {
        const auto lease = Lease::take(file_);
        ASSERT_TRUE(lease);
        EXPECT_EQ(lease_state(file_), LeaseState::kHeld);
        EXPECT_FALSE(Lease::take(file_));
    }
    EXPECT_EQ(lease_state(file_), LeaseState::kFree);
    EXPECT_TRUE(Lease::take(file_));
}

TEST_F(LeaseTest, OfAnotherMachineIsHeldWhileItsHeartBeats) {
    leave(0, 30.0);
    EXPECT_EQ(lease_state(file_), LeaseState::kHeld);
    EXPECT_FALSE(Lease::take(file_));
    leave(0, 90.0);
    EXPECT_EQ(lease_state(file_), LeaseState::kStale);
    EXPECT_TRUE(Lease::take(file_));
}

TEST_F(LeaseTest, OfAProcessThatDiedHereIsFreeAtOnce) {
    std::array<char, 256> host{};
    ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
    std::ofstream(file_) << host.data() << " 2147483646 0\n";  // no process has that number
    EXPECT_EQ(lease_state(file_), LeaseState::kStale);
}

/// A worker of a sweep that was killed at that moment held its task up for a minute, and the others left.
TEST_F(LeaseTest, IsFreeAgainWhereAProcessDiedHereAsItTookItOver) {
    std::array<char, 256> host{};
    ASSERT_EQ(::gethostname(host.data(), host.size() - 1), 0);
    std::ofstream(file_) << host.data() << " 2147483646 0 1\n";
    std::ofstream(file_.string() + ".next") << host.data() << " 2147483645 1 1\n";
    EXPECT_FALSE(Lease::take(file_));  // what was left goes
    EXPECT_TRUE(Lease::take(file_));
}

TEST_F(LeaseTest, LeavesNothingBesideItself) {
    {
        const auto lease = Lease::take(file_);
        ASSERT_TRUE(lease);
    }
    for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_EQ(entry.path().filename(), ".clock");
}

TEST_F(LeaseTest, ThatKilledTenProcessesIsWornOut) {
    leave(8, 90.0);
    EXPECT_EQ(lease_state(file_), LeaseState::kStale);
    leave(9, 90.0);
    EXPECT_EQ(lease_state(file_), LeaseState::kWornOut);
    EXPECT_FALSE(Lease::take(file_));
}

TEST_F(LeaseTest, ThatWasHalfWrittenIsTakenOver) {
    leave(0, 90.0);
    std::ofstream(file_, std::ios::trunc).close();
    const timespec long_ago{1000000000, 0};
    const std::array<timespec, 2> times{long_ago, long_ago};
    ASSERT_EQ(::utimensat(AT_FDCWD, file_.c_str(), times.data(), 0), 0);
    EXPECT_TRUE(Lease::take(file_));
}

TEST_F(LeaseTest, GoesToOneOfManyThatTryAtOnce) {
    for (int round = 0; round < 20; ++round) {
        leave(0, 90.0);
        std::atomic<int> holders{0}, most{0}, waiting{4};
        std::vector<std::jthread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&] {
                --waiting;
                while (waiting > 0) std::this_thread::yield();
                const auto lease = Lease::take(file_);
                if (!lease) return;
                most = std::max(most.load(), ++holders);
                std::this_thread::sleep_for(std::chrono::milliseconds(2));
                --holders;
            });
        threads.clear();
        EXPECT_LE(most.load(), 1) << "round " << round;
    }
}

}  // namespace
}  // namespace lamella::sweep
