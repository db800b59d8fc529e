#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lamella::app {

/// Runs a program that is found on PATH, without a shell; it reads nothing, its output is dropped and what it has to
/// say about errors goes to the file `messages`. Returns its exit status, -1 where a signal ended it.
/// @throws IoError  it is not there: `missing`; or it cannot be started
int run_external(const std::vector<std::string>& words,
                 const std::filesystem::path& messages,
                 const std::string& missing);

/// Runs this program behind the words of a launcher (mpirun), likewise. When stop_signal() is no longer 0, the launcher
/// gets SIGUSR1, which it passes on to the processes it started; it ends when this process does. Returns its exit
/// status.
/// @throws IoError  it cannot be started
int run_launcher(std::vector<std::string> launcher,
                 const std::vector<std::string>& arguments,
                 const std::filesystem::path& messages,
                 const std::function<int()>& stop_signal);

/// The last line of a text file that says something.
std::string last_line(const std::filesystem::path& file);

}  // namespace lamella::app
