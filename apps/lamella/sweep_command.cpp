#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/io/csv.h"
#include "lamella/scene/scene.h"
#include "lamella/sweep/collect.h"
#include "lamella/sweep/sweep_folder.h"
#include "lamella/sweep/worker.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "device.h"
#include "external_program.h"
#include "output.h"
#include "progress_display.h"
#include "signals.h"
#include "worker_pool.h"
#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

namespace lamella::app {
namespace {

using sweep::SweepFolder;
using sweep::TaskState;

constexpr std::array kStates{TaskState::kDone, TaskState::kRunning, TaskState::kInterrupted, TaskState::kWaiting,
                             TaskState::kFailed};
constexpr int kExitOnSignal = 128;

struct SweepOptions {
    std::string sweep, folder, task, chunk, out, at, device = "cpu", progress;
    int jobs = 0;
    bool json = false, series = false;
};

/// The state of every task; a task that was done or failed once is not asked again.
class States {
public:
    explicit States(const SweepFolder& folder) : folder_(folder), state_(folder.size(), TaskState::kWaiting) {}

    void look(const std::vector<std::size_t>& tasks) {
        for (const std::size_t task : tasks)
            if (state_[task] != TaskState::kDone && state_[task] != TaskState::kFailed)
                state_[task] = folder_.state(task);
    }
    std::size_t count(const std::vector<std::size_t>& tasks, TaskState state) const {
        return static_cast<std::size_t>(
            std::count_if(tasks.begin(), tasks.end(), [&](std::size_t t) { return state_[t] == state; }));
    }
    TaskState of(std::size_t task) const { return state_[task]; }

private:
    const SweepFolder& folder_;
    std::vector<TaskState> state_;
};

std::vector<std::size_t> all_tasks(const SweepFolder& folder) {
    std::vector<std::size_t> tasks(folder.size());
    std::iota(tasks.begin(), tasks.end(), std::size_t{0});
    return tasks;
}

/// "2/10": every tenth task from number 2 on, so that neighbors, which cost about the same, go to different jobs.
std::vector<std::size_t> chunk_tasks(const SweepFolder& folder, const std::string& text) {
    std::size_t which = 0, of = 0;
    const char *begin = text.data(), *end = begin + text.size();
    const auto [slash, bad] = std::from_chars(begin, end, which);
    if (bad == std::errc{} && slash != end && *slash == '/') {
        const auto [last, worse] = std::from_chars(slash + 1, end, of);
        if (worse != std::errc{} || last != end) of = 0;
    }
    if (of == 0 || which >= of)
        throw InputError(fmt::format("--chunk {}: write K/M with K from 0 to M - 1, for instance 0/10", text));
    std::vector<std::size_t> tasks;
    for (std::size_t task = which; task < folder.size(); task += of) tasks.push_back(task);
    return tasks;
}

std::vector<std::size_t> chosen_tasks(const SweepFolder& folder, const SweepOptions& options) {
    if (!options.task.empty()) return {folder.find(options.task)};
    return options.chunk.empty() ? all_tasks(folder) : chunk_tasks(folder, options.chunk);
}

std::string counts_text(const States& states, const std::vector<std::size_t>& tasks) {
    std::string text = fmt::format("{} of {} tasks are done", states.count(tasks, TaskState::kDone), tasks.size());
    for (const TaskState state : kStates)
        if (const std::size_t n = states.count(tasks, state); n > 0 && state != TaskState::kDone)
            text += fmt::format(", {} {}", n, sweep::name_of(state));
    return text;
}

void plan_command(const SweepOptions& options) {
    ProgressDisplay display(progress_style(options.progress));
    const SweepFolder folder =
        SweepFolder::plan(options.out, options.sweep, scene::all_solvers(), [&](std::size_t n, std::size_t of) {
            display.show({.stage = "checking scenes", .fraction = static_cast<double>(n) / static_cast<double>(of)});
        });
    display.clear();
    fmt::print(stderr,
               "{0} has {1} tasks; `lamella sweep run {0}` runs them here, `sbatch {0}/slurm.sh` on a cluster.\n",
               options.out, folder.size());
}

/// What this process does itself, without others.
int work_here(const SweepFolder& folder, const std::vector<std::size_t>& tasks, const SweepOptions& options) {
    const ThreadLimit threads(folder.options().threads);
    sweep::WorkSettings settings;
    settings.stop_signal = stop_signal;
    settings.device = options.device;
    settings.launch = [](const std::vector<std::string>& launcher, const std::vector<std::string>& arguments,
                         const std::filesystem::path& messages) {
        return run_launcher(launcher, arguments, messages, stop_signal);
    };
    const bool quiet = options.progress == "none";
    settings.on_task = [&](std::size_t task, TaskState state, const std::string& message) {
        if (state == TaskState::kFailed)
            print_error(fmt::format("task {} ({}) failed: {}", task, folder.run(task).string(), message));
        else if (!quiet)
            fmt::print(stderr, "task {} {}{}\n", task, state == TaskState::kRunning ? "begins" : "is done",
                       message.empty() ? "" : ": " + message);
    };
    const sweep::WorkResult result = sweep::work(folder, tasks, scene::all_solvers(), settings);
    if (result.signal != 0) return kExitOnSignal + result.signal;
    return result.failed > 0 ? kFailed : kDone;
}

int work_in_pool(const SweepFolder& folder,
                 const std::vector<std::size_t>& tasks,
                 const SweepOptions& options,
                 int jobs) {
    States states(folder);
    const auto open = [&] {
        return states.count(tasks, TaskState::kWaiting) + states.count(tasks, TaskState::kInterrupted);
    };
    states.look(tasks);
    const std::size_t before = states.count(tasks, TaskState::kDone);
    ProgressDisplay display(progress_style(options.progress));
    PoolSettings pool;
    pool.arguments = {"sweep", "run", options.folder, "--jobs", "1", "--progress", "none", "--device", options.device};
    if (!options.chunk.empty()) pool.arguments.insert(pool.arguments.end(), {"--chunk", options.chunk});
    pool.workers =
        static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(jobs), std::max<std::size_t>(open(), 1)));
    pool.stop_signal = stop_signal;
    pool.more = [&] {
        states.look(tasks);
        return open() > 0;
    };
    int ticks = 0;
    pool.tick = [&] {
        constexpr int kSome = 10;  // a second
        if (++ticks % kSome != 0) return;
        states.look(tasks);
        const double left = static_cast<double>(tasks.size() - before);
        const double now = static_cast<double>(states.count(tasks, TaskState::kDone) - before);
        display.show({.stage = "sweep", .text = counts_text(states, tasks), .fraction = left > 0.0 ? now / left : 1.0});
    };
    const PoolResult result = run_pool(pool);
    display.clear();
    states.look(tasks);
    fmt::print(stderr, "{}.{}\n", counts_text(states, tasks),
               result.killed > 0 ? fmt::format(" {} workers were killed and replaced.", result.killed) : "");
    return result.signal != 0 ? kExitOnSignal + result.signal : result.exit_code;
}

int run_command(const SweepOptions& options) {
    check_device(options.device);
    catch_stop_signals();
    const SweepFolder folder(options.folder);
    const std::vector<std::size_t> tasks = chosen_tasks(folder, options);
    const int cores = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
    const sweep::TaskOptions& task = folder.options();
    const int jobs = options.jobs > 0 ? options.jobs : std::max(cores / (task.threads * task.ranks), 1);
    const int code = jobs == 1 || !options.task.empty() ? work_here(folder, tasks, options)
                                                        : work_in_pool(folder, tasks, options, jobs);
    if (code != kDone) return code;
    // Some may have failed before, or all their workers have died.
    States states(folder);
    states.look(tasks);
    return states.count(tasks, TaskState::kFailed) > 0 ? kFailed : kDone;
}

void status_command(const SweepOptions& options) {
    const SweepFolder folder(options.folder);
    const std::vector<std::size_t> tasks = all_tasks(folder);
    States states(folder);
    states.look(tasks);
    if (options.json) {
        nlohmann::ordered_json json{{"tasks", folder.size()}};
        for (const TaskState state : kStates) {
            json[sweep::name_of(state)] = nlohmann::ordered_json::array();
            for (const std::size_t task : tasks)
                if (states.of(task) == state) json[sweep::name_of(state)].push_back(task);
        }
        return print_result(json.dump(2) + "\n");
    }
    std::string text = counts_text(states, tasks) + "\n";
    for (const std::size_t task : tasks)
        if (states.of(task) == TaskState::kFailed)
            text += fmt::format("task {} failed: {}/log.txt says why\n", task, folder.run(task).string());
    print_result(text);
}

void todo_command(const SweepOptions& options) {
    const SweepFolder folder(options.folder);
    std::string text;
    for (std::size_t task = 0; task < folder.size(); ++task) {
        const TaskState state = folder.state(task);
        if (state == TaskState::kWaiting || state == TaskState::kInterrupted) text += fmt::format("{}\n", task);
    }
    print_result(text);
}

void collect_command(const SweepOptions& options) {
    sweep::CollectOptions wanted;
    if (!options.at.empty()) wanted.at = sweep::parse_at(options.at);
    wanted.series = options.series;
    const sweep::Collected table = sweep::collect(SweepFolder(options.folder), wanted);
    write_result(options.out, [&](std::ostream& out) {
        out << io::csv_line(table.header);
        for (const auto& row : table.rows) out << io::csv_line(row);
    });
    for (const std::string& remark : table.remarks) fmt::print(stderr, "note: {}\n", remark);
}

void add_folder(CLI::App& command, SweepOptions& options) {
    command.add_option("folder", options.folder, "Folder of the sweep")->required()->type_name("DIR");
}

void add_plan(CLI::App& sweep, const std::shared_ptr<SweepOptions>& options) {
    CLI::App* plan = add_command(sweep, "plan", "Make the folder of a sweep, or add tasks to it",
                                 "  lamella sweep plan gas-fraction.toml --out gas-fraction\n");
    plan->add_option("sweep", options->sweep, "Which scene, which values: see docs/sweeps.md")
        ->required()
        ->type_name("SWEEP.toml");
    plan->add_option("--out", options->out, "Folder of the sweep")->required()->type_name("DIR");
    plan->callback([options] { plan_command(*options); });
}

void add_run(CLI::App& sweep, const std::shared_ptr<SweepOptions>& options, int& exit_code) {
    CLI::App* run =
        add_command(sweep, "run", "Run the tasks that are not done",
                    "  lamella sweep run gas-fraction\n"
                    "  lamella sweep run gas-fraction --jobs 8\n"
                    "  lamella sweep todo gas-fraction | parallel lamella sweep run gas-fraction --task {}\n");
    add_folder(*run, *options);
    run->add_option("--jobs", options->jobs, "Runs at a time; 0: as many as the cores allow")
        ->check(CLI::Range(0, 4096))
        ->type_name("N");
    auto* task = run->add_option("--task", options->task, "Only this one: its number or name")->type_name("K");
    run->add_option("--chunk", options->chunk, "Only every M-th task, from number K on")
        ->excludes(task)
        ->type_name("K/M");
    run->add_option("--device", options->device, "Where to compute: cpu or cuda; the runs share the GPU")
        ->check(CLI::IsMember({"cpu", "cuda"}))
        ->type_name("DEVICE");
    run->add_option("--progress", options->progress, "bar, plain or none; by default a bar on a terminal, else plain")
        ->check(CLI::IsMember({"bar", "plain", "none"}))
        ->type_name("STYLE");
    run->callback([options, &exit_code] { exit_code = run_command(*options); });
}

void add_reports(CLI::App& sweep, const std::shared_ptr<SweepOptions>& options) {
    CLI::App* status = add_command(sweep, "status", "How far a sweep is", "  lamella sweep status gas-fraction\n");
    add_folder(*status, *options);
    status->add_flag("--json", options->json, "Numbers of the tasks in each state, as JSON");
    status->callback([options] { status_command(*options); });

    CLI::App* todo = add_command(sweep, "todo", "The numbers of the tasks that wait or were interrupted",
                                 "  lamella sweep todo gas-fraction\n");
    add_folder(*todo, *options);
    todo->callback([options] { todo_command(*options); });

    CLI::App* collect = add_command(sweep, "collect", "One table of what came out",
                                    "  lamella sweep collect gas-fraction --out table.csv\n"
                                    "  lamella sweep collect gas-fraction --at scaled_time=10,20 --out table.csv\n");
    add_folder(*collect, *options);
    collect->add_option("--out", options->out, "Table to write; - is standard output")
        ->required()
        ->type_name("TABLE.csv");
    auto* at =
        collect->add_option("--at", options->at, "Rows where a column reaches these values; by default the last row")
            ->type_name("COLUMN=X,...");
    collect->add_flag("--series", options->series, "Every row of every series")->excludes(at);
    collect->callback([options] { collect_command(*options); });
}

}  // namespace

void add_sweep_command(CLI::App& app, int& exit_code) {
    CLI::App* sweep = add_command(app, "sweep", "Many runs that differ in some values of a scene",
                                  "  lamella sweep plan gas-fraction.toml --out gas-fraction\n"
                                  "  lamella sweep run gas-fraction\n"
                                  "  lamella sweep collect gas-fraction --out table.csv\n");
    sweep->require_subcommand(1);
    const auto options = std::make_shared<SweepOptions>();
    add_plan(*sweep, options);
    add_run(*sweep, options, exit_code);
    add_reports(*sweep, options);
}

}  // namespace lamella::app
