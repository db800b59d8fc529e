#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lamella::app {

/// Runs a program that is found on PATH, without a shell; it reads nothing, its output is dropped and what it has to
/// say about errors goes to the file `messages`. Returns its exit status, -1 where a signal ended it.
/// @throws IoError  it is not there: `missing`; or it cannot be started
int run_external(const std::vector<std::string>& words,
                 const std::filesystem::path& messages,
                 const std::string& missing);

/// The last line of a text file that says something.
std::string last_line(const std::filesystem::path& file);

}  // namespace lamella::app
