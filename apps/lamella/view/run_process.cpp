#include "view/run_process.h"

#include "lamella/core/error.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

namespace lamella::app::view {
namespace {

int exit_code_of(int status) {
    constexpr int kExitOnSignal = 128;
    return WIFSIGNALED(status) ? kExitOnSignal + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

RunProcess::RunProcess(const std::vector<std::string>& arguments) {
    std::vector<char*> words;  // made before the fork: a child of a program with threads may not allocate
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ < 0) throw IoError(fmt::format("the run cannot be started: {}", std::strerror(errno)));
    if (process_ == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        constexpr int kNotStarted = 127;
        if (::getppid() != parent) ::_exit(kNotStarted);  // it died before the line above
        ::execv(words[0], words.data());
        ::_exit(kNotStarted);
    }
}

RunProcess::~RunProcess() {
    stop();
    const std::lock_guard lock(mutex_);
    int status = 0;
    if (!exit_code_) ::waitpid(process_, &status, 0);
}

RunProcess::State RunProcess::state() {
    const std::lock_guard lock(mutex_);
    look();
    if (exit_code_) return State::kEnded;
    return paused_ ? State::kPaused : State::kRunning;
}

std::optional<int> RunProcess::exit_code() {
    const std::lock_guard lock(mutex_);
    look();
    return exit_code_;
}

void RunProcess::pause() {
    const std::lock_guard lock(mutex_);
    send(SIGSTOP);
    paused_ = true;
}

void RunProcess::resume() {
    const std::lock_guard lock(mutex_);
    send(SIGCONT);
    paused_ = false;
}

void RunProcess::stop() {
    const std::lock_guard lock(mutex_);
    send(SIGTERM);
    send(SIGCONT);
    paused_ = false;
}

void RunProcess::look() {
    if (exit_code_) return;
    int status = 0;
    if (::waitpid(process_, &status, WNOHANG) == process_) exit_code_ = exit_code_of(status);
}

void RunProcess::send(int signal) {
    look();  // the number of a process that was waited for may be another's
    if (!exit_code_) ::kill(process_, signal);
}

}  // namespace lamella::app::view
