#include "gnuplot.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>

extern char** environ;  // POSIX has it in no header

namespace lamella::app {
namespace {

namespace fs = std::filesystem;

std::string terminal(const fs::path& picture, int width, int height) {
    if (picture.extension() == ".png")
        return fmt::format("set terminal pngcairo size {},{} font 'DejaVu Sans,20' linewidth 2 rounded\n", width,
                           height);
    if (picture.extension() == ".svg")
        return fmt::format(
            "set terminal svg size {},{} font 'DejaVu Sans, Arial, Helvetica, sans-serif,20' linewidth 2 "
            "rounded background rgb 'white'\n",
            width, height);
    throw InputError(fmt::format("{}: a picture ends with .png or .svg", picture.string()));
}

/// Runs gnuplot on the script, its messages going to a file; returns the exit status.
int run_gnuplot(const fs::path& script, const fs::path& messages) {
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    std::string program = "gnuplot";
    std::string no_settings = "--default-settings";
    std::string file = script.string();
    const std::array<char*, 4> arguments{program.data(), no_settings.data(), file.data(), nullptr};
    pid_t child = 0;
    const int error = ::posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT)
        throw IoError("gnuplot is needed for plots and is not on the PATH (Debian: apt install gnuplot-nox)");
    if (error != 0) throw IoError(fmt::format("gnuplot: {}", std::strerror(error)));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) throw IoError(fmt::format("gnuplot: {}", std::strerror(errno)));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// The last line of gnuplot's messages that says something.
std::string last_message(const fs::path& messages) {
    std::string text = io::read_file(messages);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    const std::size_t line = text.rfind('\n');
    return line == std::string::npos ? text : text.substr(line + 1);
}

}  // namespace

Gnuplot::Gnuplot() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "lamella_plot_XXXXXX").string();
    if (error || ::mkdtemp(name.data()) == nullptr)
        throw IoError(fmt::format("no temporary folder for gnuplot: {}", std::strerror(errno)));
    folder_ = name;
}

Gnuplot::~Gnuplot() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::string Gnuplot::data(const Columns& columns) {
    const fs::path path = folder_ / fmt::format("data{}.txt", files_++);
    fmt::memory_buffer text;
    const std::size_t rows = columns.empty() ? 0 : columns.front().size();
    for (std::size_t row = 0; row < rows; ++row) {
        for (const auto& column : columns) fmt::format_to(std::back_inserter(text), "{:.9g} ", column[row]);
        text.push_back('\n');
    }
    if (rows == 0) text.append(std::string_view("NaN NaN NaN NaN\n"));  // gnuplot refuses an empty file
    io::write_file_atomically(path, {text.data(), text.size()});
    return gnuplot_text(path.string());
}

void Gnuplot::draw(const std::string& script, const fs::path& picture, int width, int height) {
    const fs::path drawn = folder_ / "picture";
    const fs::path script_file = folder_ / "script.gp";
    const fs::path messages = folder_ / "messages.txt";
    io::write_file_atomically(script_file, "set encoding utf8\n" + terminal(picture, width, height) + "set output " +
                                               gnuplot_text(drawn.string()) + "\n" + script + "\nunset output\n");
    if (run_gnuplot(script_file, messages) != 0 || !fs::exists(drawn))
        throw IoError(fmt::format("gnuplot could not draw {}: {}", picture.string(), last_message(messages)));
    io::write_file_atomically(picture, io::read_file(drawn));
}

std::string gnuplot_text(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'') result += '\'';  // doubled: the only escape inside single quotes
        result += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
    }
    return result + "'";
}

}  // namespace lamella::app
