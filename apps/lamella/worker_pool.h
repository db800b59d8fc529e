#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace lamella::app {

/// How a pool of processes of this program ended.
struct PoolResult {
    int signal = 0;          ///< that this process was asked to stop with, or 0
    int exit_code = 0;       ///< the worst that a worker ended with by itself
    std::size_t killed = 0;  ///< workers that a signal ended that nobody here had sent
};

struct PoolSettings {
    std::vector<std::string> arguments;  ///< of each worker, without the program
    int workers = 1;
    std::function<int()> stop_signal;                  ///< asked all the time; the workers get it passed on
    std::function<bool()> more = [] { return true; };  ///< whether a worker that was killed is worth another
    std::function<void()> tick = [] {};                ///< ten times a second
};

/// Runs processes of this program until each has ended. Their standard output is this one's; what they report goes the
/// same way. One that is killed is replaced as long as there is work.
/// @throws IoError  a process cannot be started
PoolResult run_pool(const PoolSettings& settings);

}  // namespace lamella::app
