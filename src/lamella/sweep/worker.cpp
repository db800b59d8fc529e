#include "lamella/sweep/worker.h"

#include "lamella/core/error.h"
#include "lamella/run/run_folder.h"
#include "lamella/scene/scene.h"
#include "lamella/sweep/lease.h"

#include <optional>
#include <vector>

namespace lamella::sweep {
namespace {

bool is_open(TaskState state) { return state == TaskState::kWaiting || state == TaskState::kInterrupted; }

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
                const run::RunResult run = run_task(folder, task, registry, run_settings);
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
