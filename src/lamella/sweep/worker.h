#pragma once

#include "lamella/run/run.h"
#include "lamella/sweep/sweep_folder.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lamella::sweep {

struct WorkSettings {
    std::function<int()> stop_signal = [] { return 0; };  ///< as run::RunSettings has it
    std::function<void(std::size_t task, TaskState state, const std::string& message)> on_task =
        [](std::size_t, TaskState, const std::string&) {};  ///< a task begins (kRunning) or ends
    std::string device = "cpu";

    /// For tasks of several ranks: starts this program with these arguments behind the words of a launcher, waits for
    /// it, and asks it to stop when stop_signal() says so. Returns its exit status.
    /// @param messages  file for what it says
    std::function<int(const std::vector<std::string>& launcher,
                      const std::vector<std::string>& arguments,
                      const std::filesystem::path& messages)>
        launch;
};

struct WorkResult {
    std::size_t done = 0;    ///< by this call
    std::size_t failed = 0;  ///< by this call
    int signal = 0;          ///< that stopped it, or 0
};

/// Works on the given tasks that nobody else works on and that are neither done nor failed, one after another, until
/// none is left. A run that was interrupted goes on from its checkpoint. A run that fails is left as it is, with its
/// last good state.
/// @throws IoError  nothing can be written any more
WorkResult work(const SweepFolder& folder,
                std::span<const std::size_t> tasks,
                const sim::SolverRegistry& registry,
                const WorkSettings& settings);

}  // namespace lamella::sweep
