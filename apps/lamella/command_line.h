#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace lamella::app {

/// Adds a subcommand with its one-line summary and, below the options of its --help, the examples.
CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& summary, const std::string& examples);

/// The one line that explains a command line CLI11 did not understand, with the nearest command or option.
std::string misuse_text(const CLI::App& app, const CLI::ParseError& error, std::vector<std::string> arguments);

}  // namespace lamella::app
