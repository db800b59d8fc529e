#include "worker_pool.h"

#include "lamella/core/error.h"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>

namespace lamella::app {
namespace {

constexpr const char* kThisProgram = "/proc/self/exe";

pid_t start(std::vector<std::string> words) {
    words.insert(words.begin(), "lamella");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t process = 0;
    const int error = ::posix_spawn(&process, kThisProgram, nullptr, nullptr, arguments.data(), environ);
    if (error != 0) throw IoError(fmt::format("a worker cannot be started: {}", std::strerror(error)));
    return process;
}

}  // namespace

PoolResult run_pool(const PoolSettings& settings) {
    PoolResult result;
    std::vector<pid_t> workers;
    for (int i = 0; i < settings.workers; ++i) workers.push_back(start(settings.arguments));
    while (!workers.empty()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        settings.tick();
        const int signal = settings.stop_signal();
        if (signal != 0 && result.signal == 0) {
            result.signal = signal;
            for (const pid_t worker : workers) ::kill(worker, SIGTERM);
        }
        for (pid_t& worker : workers) {
            int status = 0;
            if (::waitpid(worker, &status, WNOHANG) != worker) continue;
            worker = 0;
            if (WIFEXITED(status)) {
                if (result.signal == 0) result.exit_code = std::max(result.exit_code, WEXITSTATUS(status));
                continue;
            }
            ++result.killed;
            if (result.signal == 0 && settings.more()) worker = start(settings.arguments);
        }
        workers.erase(std::remove(workers.begin(), workers.end(), 0), workers.end());
        // A worker that was killed as it took a task over keeps others from it for a moment: the last may have left.
        if (workers.empty() && result.signal == 0 && result.exit_code == 0 && settings.more())
            workers.push_back(start(settings.arguments));
    }
    return result;
}

}  // namespace lamella::app
