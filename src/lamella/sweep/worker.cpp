#include "lamella/sweep/worker.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/run/run_folder.h"
#include "lamella/scene/scene.h"
#include "lamella/sweep/lease.h"

#include <fmt/format.h>

#include <optional>
#include <sstream>
#include <vector>

namespace lamella::sweep {
namespace {

bool is_open(TaskState state) { return state == TaskState::kWaiting || state == TaskState::kInterrupted; }

std::vector<std::string> launcher_words(const TaskOptions& task) {
    std::istringstream text(task.launcher);
    std::vector<std::string> words;
    for (std::string word; text >> word;) words.push_back(word == "{ranks}" ? std::to_string(task.ranks) : word);
    return words;
}

std::string last_line(const std::filesystem::path& file) {
    std::istringstream text(io::read_file(file));
    std::string last;
    for (std::string line; std::getline(text, line);)
        if (line.starts_with("lamella: ")) last = line.substr(9);
    return last;
}

/// A run of several processes is a program of its own, behind a launcher.
run::RunResult run_ranks(const SweepFolder& folder, std::size_t task, const WorkSettings& settings) {
    const std::string run = folder.run(task).string();
    std::vector<std::string> arguments{"run", folder.scene(task).string(), "--out", run};
    if (run::is_run_folder(run)) arguments = {"resume", run};
    for (const char* more : {"--progress", "none", "--threads"}) arguments.emplace_back(more);
    arguments.push_back(std::to_string(folder.options().threads));
    arguments.insert(arguments.end(), {"--device", settings.device});
    const std::filesystem::path messages = folder.messages(task);
    const int status = settings.launch(launcher_words(folder.options()), arguments, messages);
    run::RunResult result;
    result.finished = status == 0;
    result.signal = status == 0 ? 0 : settings.stop_signal();
    if (result.finished || result.signal != 0) return result;
    const std::string what = last_line(messages);
    throw NumericalError(what.empty() ? fmt::format("its processes ended with status {}: {}", status, messages.string())
                                      : what);
}

run::RunResult run_task(const SweepFolder& folder,
                        std::size_t task,
                        const sim::SolverRegistry& registry,
                        const run::RunSettings& settings) {
    if (run::is_run_folder(folder.run(task))) return run::resume_run(folder.run(task), registry, settings);
    return run::run_scene(scene::load_scene(folder.scene(task), {}, registry), registry, folder.run(task), settings);
}

}  // namespace

WorkResult work(const SweepFolder& folder,
                std::span<const std::size_t> tasks,
                const sim::SolverRegistry& registry,
                const WorkSettings& settings) {
    run::RunSettings run_settings;
    run_settings.stop_signal = settings.stop_signal;
    run_settings.device = settings.device;
    WorkResult result;
    std::vector<bool> given_up(folder.size(), false);
    const auto fail = [&](std::size_t task, const std::string& message) {
        given_up[task] = true;
        ++result.failed;
        settings.on_task(task, TaskState::kFailed, message);
    };
    for (bool any = true; any;) {  // again, because others may have died meanwhile
        any = false;
        for (const std::size_t task : tasks) {
            result.signal = settings.stop_signal();
            if (result.signal != 0) return result;
            if (given_up[task] || !is_open(folder.state(task))) continue;
            const std::optional<Lease> lease = Lease::take(folder.lease(task));
            if (!lease || folder.state(task) == TaskState::kDone) continue;
            any = true;
            settings.on_task(task, TaskState::kRunning, "");
            try {
                const run::RunResult run = folder.options().ranks > 1 ? run_ranks(folder, task, settings)
                                                                      : run_task(folder, task, registry, run_settings);
                result.signal = run.signal;
                if (!run.finished) return result;
                ++result.done;
                settings.on_task(task, TaskState::kDone, run.stop_reason);
            } catch (const NumericalError& error) {
                fail(task, error.what());
            } catch (const InputError& error) {  // damaged, or another process is in it
                fail(task, error.what());
            }
        }
    }
    return result;
}

}  // namespace lamella::sweep
