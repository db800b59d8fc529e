#include "external_program.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

extern char** environ;  // POSIX has it in no header

namespace lamella::app {
namespace {

constexpr int kNotStarted = 127;  // as shells have it

}  // namespace

int run_external(const std::vector<std::string>& words,
                 const std::filesystem::path& messages,
                 const std::string& missing) {
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    std::vector<std::string> copies = words;
    std::vector<char*> arguments;
    for (std::string& word : copies) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    const int error = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT) throw IoError(missing);
    if (error != 0) throw IoError(fmt::format("{}: {}", words[0], std::strerror(error)));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw IoError(fmt::format("{}: {}", words[0], std::strerror(errno)));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int run_launcher(std::vector<std::string> launcher,
                 const std::vector<std::string>& arguments,
                 const std::filesystem::path& messages,
                 const std::function<int()>& stop_signal) {
    launcher.push_back(std::filesystem::read_symlink("/proc/self/exe").string());
    launcher.insert(launcher.end(), arguments.begin(), arguments.end());
    std::vector<char*> words;
    for (std::string& word : launcher) words.push_back(word.data());
    words.push_back(nullptr);
    const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    const int out = ::open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (nothing < 0 || out < 0) throw IoError(fmt::format("{}: {}", messages.string(), std::strerror(errno)));
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) ::_exit(kNotStarted);
        ::dup2(nothing, STDIN_FILENO);
        ::dup2(nothing, STDOUT_FILENO);
        ::dup2(out, STDERR_FILENO);
        ::execvp(words[0], words.data());
        ::_exit(kNotStarted);
    }
    ::close(nothing);
    ::close(out);
    if (child < 0) throw IoError(fmt::format("{}: {}", launcher[0], std::strerror(errno)));
    int status = 0;
    for (bool told = false; ::waitpid(child, &status, WNOHANG) == 0;) {
        if (!told && stop_signal() != 0) told = ::kill(child, SIGUSR1) == 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (code == kNotStarted) throw IoError(fmt::format("{} cannot be started: task.launcher", launcher[0]));
    return code;
}

std::string last_line(const std::filesystem::path& file) {
    std::string text = io::read_file(file);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    const std::size_t line = text.rfind('\n');
    return line == std::string::npos ? text : text.substr(line + 1);
}

}  // namespace lamella::app
