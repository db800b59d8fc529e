#pragma once

#include "lamella/core/log.h"
#include "lamella/run/run_folder.h"
#include "lamella/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace lamella::run {

/// Where a run is, for a display.
struct RunProgress {
    std::string stage;               ///< "run", or what the solver does while it starts
    std::string text = {};           ///< more about a stage other than "run"
    std::optional<double> fraction;  ///< of that stage that is done, 0 to 1; nothing when nobody knows
    double time = 0.0;               ///< in time_unit
    std::string time_unit = "s";
    std::int64_t step = 0;
    std::int64_t frames = 0;  ///< written so far
};

/// How to run, beside what the scene says.
struct RunSettings {
    std::optional<double> until = {};       ///< stop at this time instead of the scene's end
    Existing existing = Existing::kRefuse;  ///< what to do with a run that is in the folder
    std::string device = "cpu";             ///< or "cuda"; recorded in run.json
    /// The processes that compute together; empty: this one. All of them make the same call. Process 0 returns as
    /// ever; it alone touches the folder and calls the functions below. The others return when it does, with an empty
    /// result.
    std::shared_ptr<dist::Communicator> processes = nullptr;
    /// The input is right and the folder is taken; work begins.
    std::function<void(const scene::Scene&)> on_begin = [](const scene::Scene&) {};
    /// The number of the signal that asks to stop, 0 for none. Asked after every step, and while the solver starts.
    std::function<int()> stop_signal = [] { return 0; };
    std::function<void(const RunProgress&)> on_progress = [](const RunProgress&) {};  ///< after every step
    LogSink log = [](LogLevel, std::string_view) {};                                  ///< gets what goes to log.txt
    /// Hears why this process ends all others: it met an error that they do not know of, and does not return.
    std::function<void(std::string_view)> last_words = [](std::string_view) {};
    std::function<double()> wall_clock = {};  ///< seconds, for checkpoint intervals; empty: the system's steady clock
};

struct RunResult {
    bool finished = false;    ///< false: a signal stopped it
    int signal = 0;           ///< which one
    std::string stop_reason;  ///< "the end time 10 is reached", "300 bubbles are left", "interrupted by signal 2"
    double time = 0.0;
    std::string time_unit = "s";
    std::int64_t step = 0;
    std::int64_t steps_taken = 0;  ///< by this call
    std::int64_t frames = 0;
};

/// Runs a scene into a folder (design: scene.toml, run.json, series.csv, events.csv, frames/, frames.pvd,
/// checkpoint.h5, log.txt) until the solver's own end, the scene's end time, or a signal.
///
/// Whatever ends it (a signal, a full disk, SIGKILL), resume_run continues from the last checkpoint, and the files
/// series.csv, events.csv and frames/ come out bit for bit as if nothing had happened.
///
/// @throws InputError      the folder cannot be used (see RunFolder::create); nothing was written
/// @throws IoError         a file cannot be written; what the last checkpoint needs is intact
/// @throws NumericalError  the state of the last completed step has been saved as the checkpoint, the message says so
RunResult run_scene(const scene::Scene& scene,
                    const sim::SolverRegistry& registry,
                    const std::filesystem::path& folder,
                    const RunSettings& settings);

/// Continues a run from its last checkpoint (from the one before, should the last be damaged; from the scene, should
/// there be none). A run that is at its end already returns at once.
/// @throws  as run_scene; InputError also when every checkpoint is damaged
RunResult resume_run(const std::filesystem::path& folder,
                     const sim::SolverRegistry& registry,
                     const RunSettings& settings);

}  // namespace lamella::run
