#pragma once

#include "lamella/sim/registry.h"
#include "lamella/sweep/sweep.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lamella::sweep {

/// What the folder of a task says of it.
enum class TaskState { kWaiting, kRunning, kInterrupted, kDone, kFailed };
const char* name_of(TaskState state);

/// The folder of a sweep (docs/sweeps.md): tasks.csv, scenes/NAME.toml, runs/NAME/, leases/NAME, sweep.toml, slurm.sh.
/// Nobody keeps a record of what is done beside the runs themselves.
class SweepFolder {
public:
    /// Makes the folder, or adds to the tasks of one that is there those that it lacks. Every scene is checked before
    /// anything is written.
    /// @param on_checked  told how many scenes are checked so far
    /// @throws InputError  a scene is wrong; the folder is another sweep's: it has other keys, or another scene for the
    /// same task
    /// @throws IoError
    static SweepFolder plan(const std::filesystem::path& path,
                            const std::filesystem::path& sweep_file,
                            const sim::SolverRegistry& registry,
                            const std::function<void(std::size_t, std::size_t)>& on_checked);
    /// @throws InputError  no folder of a sweep   @throws IoError
    explicit SweepFolder(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path scene(std::size_t task) const { return path_ / "scenes" / (names_[task] + ".toml"); }
    std::filesystem::path run(std::size_t task) const { return path_ / "runs" / names_[task]; }
    std::filesystem::path lease(std::size_t task) const { return path_ / "leases" / names_[task]; }
    /// What the launcher of a task of several ranks said last.
    std::filesystem::path messages(std::size_t task) const { return lease(task).string() + ".messages"; }
    std::filesystem::path table() const { return path_ / "tasks.csv"; }

    std::size_t size() const { return names_.size(); }
    const std::string& name(std::size_t task) const { return names_[task]; }
    const std::vector<std::string>& keys() const { return keys_; }
    const std::vector<std::string>& values(std::size_t task) const { return values_[task]; }
    const TaskOptions& options() const { return options_; }

    /// The task that "17" or its name means. @throws InputError
    std::size_t find(const std::string& text) const;
    TaskState state(std::size_t task) const;

private:
    SweepFolder() = default;

    std::filesystem::path path_;
    std::vector<std::string> keys_, names_;
    std::vector<std::vector<std::string>> values_;
    TaskOptions options_;
};

}  // namespace lamella::sweep
