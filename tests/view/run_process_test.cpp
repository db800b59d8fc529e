#include <gtest/gtest.h>

#include "view/run_process.h"
#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

namespace lamella::app::view {
namespace {

bool soon(const std::function<bool()>& happens) {
    for (int i = 0; i < 500; ++i) {
        if (happens()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

TEST(RunProcess, TellsHowItEnded) {
    RunProcess process({"/bin/sh", "-c", "exit 3"});
    EXPECT_TRUE(soon([&] { return process.state() == RunProcess::State::kEnded; }));
    EXPECT_EQ(process.exit_code(), 3);
    process.pause();  // too late, and no harm
    EXPECT_EQ(process.state(), RunProcess::State::kEnded);
}

TEST(RunProcess, CanBePausedResumedAndStopped) {
    RunProcess process({"/bin/sleep", "60"});
    EXPECT_EQ(process.state(), RunProcess::State::kRunning);
    process.pause();
    EXPECT_EQ(process.state(), RunProcess::State::kPaused);
    process.resume();
    EXPECT_EQ(process.state(), RunProcess::State::kRunning);
    process.pause();
    process.stop();  // wakes it, or it would never end
    EXPECT_TRUE(soon([&] { return process.state() == RunProcess::State::kEnded; }));
    EXPECT_EQ(process.exit_code(), 128 + SIGTERM);
}

TEST(RunProcess, EndsWithItsObject) {
    const auto begin = std::chrono::steady_clock::now();
    { const RunProcess process({"/bin/sleep", "60"}); }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

}  // namespace
}  // namespace lamella::app::view
