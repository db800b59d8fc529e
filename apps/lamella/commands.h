#pragma once

// The commands of the program, one per file. Each add_... describes its command line to CLI11; the command runs when
// the line is parsed, and leaves its exit code in `exit_code`.

#include <CLI/CLI.hpp>

namespace lamella::app {

/// Exit codes of the program (besides 128 + signal number when interrupted).
enum ExitCode { kDone = 0, kWrongInput = 2, kFailed = 3, kFileTrouble = 4 };

void add_run_commands(CLI::App& app, int& exit_code);  ///< run, resume
void add_check_command(CLI::App& app);
void add_scenes_command(CLI::App& app);
void add_explain_command(CLI::App& app);
void add_sweep_command(CLI::App& app, int& exit_code);  ///< sweep plan, run, status, todo, collect
void add_measure_command(CLI::App& app);
void add_plot_command(CLI::App& app);
void add_render_command(CLI::App& app, int& exit_code);
void add_export_command(CLI::App& app);
void add_import_command(CLI::App& app);
void add_version_command(CLI::App& app);
void add_view_command(CLI::App& app, int& exit_code);

}  // namespace lamella::app
