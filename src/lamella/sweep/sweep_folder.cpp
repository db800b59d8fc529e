#include "lamella/sweep/sweep_folder.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/csv.h"
#include "lamella/run/provenance.h"
#include "lamella/run/run_folder.h"
#include "lamella/scene/scene.h"
#include "lamella/scene/toml_file.h"
#include "lamella/sim/read_options.h"
#include "lamella/sweep/lease.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

namespace lamella::sweep {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> table_header(const std::vector<std::string>& keys) {
    std::vector<std::string> header{"task", "name"};
    header.insert(header.end(), keys.begin(), keys.end());
    return header;
}

/// The job of a cluster that works on a share of the tasks, and comes back as long as there is something to do.
std::string slurm_script(const fs::path& folder, std::size_t tasks, const TaskOptions& task) {
    const std::size_t per_job = static_cast<std::size_t>(task.per_job);
    const std::size_t jobs = std::max<std::size_t>((tasks + per_job - 1) / per_job, 1);
    return fmt::format(R"(#!/bin/bash
# A sweep of lamella as an array of jobs: sbatch slurm.sh
# Each job does its share of the tasks. Two minutes before its time is up its runs write checkpoints, and it queues again.
#SBATCH --job-name=lamella
#SBATCH --array=0-{last}
#SBATCH --ntasks={ranks}
#SBATCH --cpus-per-task={threads}
#SBATCH --mem={memory}
#SBATCH --time={wall}
#SBATCH --signal=B:TERM@120
#SBATCH --requeue
#SBATCH --open-mode=append

lamella=${{LAMELLA:-lamella}}
folder={folder}
chunk=$SLURM_ARRAY_TASK_ID/{jobs}

"$lamella" sweep run "$folder" --jobs 1 --chunk "$chunk" &
worker=$!
trap 'kill -TERM $worker' TERM
wait $worker
status=$?
[ $status -lt 128 ] || {{ wait $worker; status=$?; }}  # the trap ended the first wait
if [ $status -ge 128 ]; then
    scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
fi
exit $status
)",
                       fmt::arg("last", jobs - 1), fmt::arg("jobs", jobs), fmt::arg("threads", task.threads),
                       fmt::arg("ranks", task.ranks), fmt::arg("memory", task.memory), fmt::arg("wall", task.wall),
                       fmt::arg("folder", sim::quoted_text(fs::absolute(folder).lexically_normal().string())));
}

struct CheckedScene {
    std::size_t task;
    std::string text;
};

/// The scenes of the tasks, every default filled in. @throws InputError
std::vector<CheckedScene> check_scenes(const Sweep& sweep,
                                       const sim::SolverRegistry& registry,
                                       const std::function<void(std::size_t, std::size_t)>& on_checked) {
    std::vector<CheckedScene> scenes;
    for (std::size_t i = 0; i < sweep.tasks.size(); ++i) {
        const Task& task = sweep.tasks[i];
        try {
            const scene::Scene scene = scene::load_scene(sweep.scene, task.overrides, registry);
            scene::create_solver(scene, registry);
            scenes.push_back({i, scene::resolved_toml(scene, registry)});
        } catch (const InputError& error) {
            throw InputError(fmt::format("{} (task {}: {})", error.what(), i, fmt::join(task.overrides, ", ")));
        }
        on_checked(i + 1, sweep.tasks.size());
    }
    return scenes;
}

/// A task keeps its scene: one that reads otherwise now belongs to another sweep.
void refuse_other_scene(const fs::path& file, const std::string& text) {
    if (!fs::exists(file) || io::read_file(file) == text) return;
    throw InputError(
        fmt::format("{} differs from what the scene gives now; the scene or lamella changed since this sweep was "
                    "planned: plan another folder",
                    file.string()));
}

void refuse_other_folder(const fs::path& path) {
    if (!fs::exists(path)) return;
    if (!fs::is_directory(path))
        throw InputError(fmt::format("{} is not a folder; choose another --out", path.string()));
    if (!fs::is_empty(path) && !fs::is_regular_file(path / "tasks.csv"))
        throw InputError(fmt::format("{} holds files that are not a sweep's; choose another --out", path.string()));
}

/// Adds the tasks that tasks.csv lacks below those that it has: their numbers stay.
void extend_table(const fs::path& path, const Sweep& sweep, const std::set<std::string>& known) {
    std::size_t next = known.size();
    std::string rows;
    auto writer =
        known.empty() ? io::CsvWriter(path, table_header(sweep.keys)) : io::CsvWriter(path, fs::file_size(path));
    for (const Task& task : sweep.tasks) {
        if (known.count(task.name) != 0) continue;
        std::vector<std::string> row{fmt::format("{}", next++), task.name};
        row.insert(row.end(), task.values.begin(), task.values.end());
        writer.append_text(row);
    }
    writer.sync();
}

}  // namespace

const char* name_of(TaskState state) {
    switch (state) {
        case TaskState::kWaiting:
            return "waiting";
        case TaskState::kRunning:
            return "running";
        case TaskState::kInterrupted:
            return "interrupted";
        case TaskState::kDone:
            return "done";
        case TaskState::kFailed:
            return "failed";
    }
    return "";
}

SweepFolder SweepFolder::plan(const fs::path& path,
                              const fs::path& sweep_file,
                              const sim::SolverRegistry& registry,
                              const std::function<void(std::size_t, std::size_t)>& on_checked) {
    const Sweep sweep = load_sweep(sweep_file);
    refuse_other_folder(path);
    std::set<std::string> known;
    if (fs::exists(path / "tasks.csv")) {
        const SweepFolder old(path);
        if (old.keys() != sweep.keys)
            throw InputError(fmt::format("{} varies {}, and {} varies {}; plan another folder", path.string(),
                                         fmt::join(old.keys(), ", "), sweep_file.string(),
                                         fmt::join(sweep.keys, ", ")));
        known.insert(old.names_.begin(), old.names_.end());
    }
    const std::vector<CheckedScene> scenes = check_scenes(sweep, registry, on_checked);
    const auto file_of = [&](const CheckedScene& s) { return path / "scenes" / (sweep.tasks[s.task].name + ".toml"); };
    for (const CheckedScene& scene : scenes) refuse_other_scene(file_of(scene), scene.text);

    for (const char* folder : {"scenes", "runs", "leases"}) fs::create_directories(path / folder);
    for (const CheckedScene& scene : scenes)
        if (!fs::exists(file_of(scene))) io::write_file_atomically(file_of(scene), scene.text);
    io::write_file_atomically(path / "sweep.toml", io::read_file(sweep_file));
    extend_table(path / "tasks.csv", sweep, known);
    SweepFolder folder(path);
    io::write_file_atomically(path / "slurm.sh", slurm_script(path, folder.size(), folder.options()));
    fs::permissions(path / "slurm.sh", fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                    fs::perm_options::add);
    return folder;
}

SweepFolder::SweepFolder(fs::path path) : path_(std::move(path)) {
    if (!fs::is_regular_file(table()) || !fs::is_regular_file(path_ / "sweep.toml"))
        throw InputError(fmt::format("{} is no folder of a sweep; `lamella sweep plan SWEEP.toml --out {}` makes one",
                                     path_.string(), path_.string()));
    const io::CsvTextTable tasks = io::read_csv_text(table());
    if (tasks.header.size() < 2 || tasks.header[0] != "task" || tasks.header[1] != "name")
        throw InputError({table().string(), 1, 0}, "is no table of tasks: its columns begin with task,name");
    keys_.assign(tasks.header.begin() + 2, tasks.header.end());
    for (const auto& row : tasks.rows) {
        if (row[1].size() != 16 || row[1].find_first_not_of("0123456789abcdef") != std::string::npos)
            throw InputError({table().string()}, fmt::format("{} is no name of a task", sim::quoted_text(row[1])));
        names_.push_back(row[1]);
        values_.emplace_back(row.begin() + 2, row.end());
    }
    const sim::Node root = scene::read_toml_file(path_ / "sweep.toml");
    if (const sim::Node* task = root.find("task")) options_ = sim::read_options<TaskOptions>(*task);
}

std::size_t SweepFolder::find(const std::string& text) const {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc{} && end == text.data() + text.size() && number < size()) return number;
    const auto found = std::find(names_.begin(), names_.end(), text);
    if (found == names_.end())
        throw InputError(
            fmt::format("--task {} is none of {}: it has tasks 0 to {}", text, path_.string(), size() - 1));
    return static_cast<std::size_t>(found - names_.begin());
}

TaskState SweepFolder::state(std::size_t task) const {
    const std::string recorded = run::recorded_state(run(task) / "run.json");
    if (recorded == "finished") return TaskState::kDone;
    const LeaseState held = lease_state(lease(task));
    if (held == LeaseState::kHeld) return TaskState::kRunning;
    if (recorded == "failed" || held == LeaseState::kWornOut) return TaskState::kFailed;
    return run::is_run_folder(run(task)) ? TaskState::kInterrupted : TaskState::kWaiting;
}

}  // namespace lamella::sweep
