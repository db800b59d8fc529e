#include "lamella/core/build_info.h"
#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/core/progress.h"
#include "lamella/dist/agree.h"
#include "lamella/dist/world.h"
#include "lamella/run/run.h"
#include "lamella/scene/scene.h"
#include "lamella/scene/shipped.h"

#include <fmt/format.h>

#include "command_line.h"
#include "commands.h"
#include "device.h"
#include "output.h"
#include "progress_display.h"
#include "signals.h"
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

struct RunOptions {
    std::string scene;
    std::string folder;
    std::vector<std::string> overrides;
    std::optional<double> until;
    int threads = 0;
    std::string device = "cpu";
    bool overwrite = false;
    std::string progress;
};

void add_common_options(CLI::App& command, RunOptions& options) {
    command.add_option("--until", options.until, "Stop at this time instead of the scene's end")->type_name("T");
    command.add_option("--threads", options.threads, "Worker threads; 0: one per core")
        ->check(CLI::Range(0, 4096))
        ->type_name("N");
    command.add_option("--device", options.device, "Where to compute: cpu or cuda")
        ->check(CLI::IsMember({"cpu", "cuda"}))
        ->type_name("DEVICE");
    command
        .add_option("--progress", options.progress, "bar, plain or none; by default a bar on a terminal, else plain")
        ->check(CLI::IsMember({"bar", "plain", "none"}))
        ->type_name("STYLE");
}

/// "runs/coarsening-2d" for scenes/bubble/coarsening-2d.toml.
std::string default_folder(const std::filesystem::path& scene) {
    return (std::filesystem::path("runs") / scene.stem()).string();
}

sim::Node empty_table() {
    sim::Node node;
    node.value = sim::Node::Table{};
    return node;
}

/// The scene's options of its own solver; an empty table where it gives none.
sim::Node solver_options(const scene::Scene& scene) {
    const sim::Node* node = scene.root.find(scene.solver);
    return node != nullptr ? *node : empty_table();
}

/// Every option of the group compat that is not at its default: a run that deviates from the right physics says so.
std::vector<std::string> compat_deviations(const scene::Scene& scene, const sim::SolverEntry& entry) {
    std::vector<std::string> lines;
    const sim::Node used = entry.resolve(solver_options(scene));
    const sim::Node defaults = entry.resolve(empty_table());
    const sim::Node* used_group = used.find("compat");
    const sim::Node* default_group = defaults.find("compat");
    if (used_group == nullptr || default_group == nullptr || used_group->table() == nullptr) return lines;
    for (const auto& [key, value] : *used_group->table()) {
        const sim::Node* standard = default_group->find(key);
        if (standard != nullptr && sim::found_text(*standard) != sim::found_text(value))
            lines.push_back(fmt::format("{}.compat.{} = {} (default {})", scene.solver, key, sim::found_text(value),
                                        sim::found_text(*standard)));
    }
    return lines;
}

void print_header(const scene::Scene& scene,
                  const sim::SolverRegistry& registry,
                  const std::string& folder,
                  int processes) {
    const BuildInfo build = build_info();
    const sim::SolverEntry& entry = *registry.find(scene.solver);
    std::string solver = entry.name;
    const sim::Node resolved = entry.resolve(solver_options(scene));
    for (const char* size : {"dimension", "count"})
        if (const sim::Node* node = resolved.find(size)) solver += fmt::format(", {} {}", size, sim::found_text(*node));

    std::vector<std::pair<std::string, std::string>> rows{
        {"scene", scene.title.empty() ? scene.file : fmt::format("{} ({})", scene.title, scene.file)},
        {"solver", solver},
        {"threads", std::to_string(thread_count())},
        {"folder", folder}};
    if (processes > 1) rows.insert(rows.begin() + 2, {"processes", std::to_string(processes)});
    for (const std::string& deviation : compat_deviations(scene, entry)) rows.emplace_back("compat", deviation);
    fmt::print(stderr, "lamella {} ({})\n{}", build.version, build.commit, two_columns(rows));
}

void print_summary(const run::RunResult& result, const std::string& folder, double seconds) {
    const std::string time =
        fmt::format("{:.6g}{}", result.time, result.time_unit == "-" ? "" : " " + result.time_unit);
    if (!result.finished) {
        fmt::print(stderr,
                   "Stopped at time {0}, step {1}, after {2}; a checkpoint was written.\n"
                   "`lamella resume {3}` continues.\n",
                   time, result.step, duration_text(seconds), folder);
        return;
    }
    if (result.steps_taken == 0)
        fmt::print(stderr, "Nothing to do: {} (time {}, step {}).\n", result.stop_reason, time, result.step);
    else
        fmt::print(stderr, "Done in {}: {} (time {}, {} steps).\n", duration_text(seconds), result.stop_reason, time,
                   result.step);
    fmt::print(stderr,
               "{0}/series.csv has the series, {0}/frames.pvd the {1} frames (ParaView); `lamella plot {0}` "
               "draws them.\n",
               folder, result.frames);
}

using Processes = std::shared_ptr<dist::Communicator>;

/// Does `work` with the processes that a launcher started and their threads. Only process 0 speaks: the others have no
/// errors that it has not.
template <class Work>
int with_processes(const RunOptions& options, Work&& work) {
    const Processes processes = dist::join_world();
    const bool chosen = options.threads > 0 || !processes->several();
    const ThreadLimit threads(chosen ? options.threads : dist::threads_per_process());
    try {
        return work(processes);
    } catch (const std::exception&) {
        if (processes->rank() == 0) throw;
        return kDone;  // a launcher then reports the exit code of process 0
    }
}

/// Runs `work` with signals and progress set up; returns the exit code.
template <class Work>
int supervise(const RunOptions& options,
              const std::string& folder,
              const sim::SolverRegistry& registry,
              const Processes& processes,
              Work&& work) {
    catch_stop_signals();
    const auto last_words = [&](std::string_view text) {
        print_error(fmt::format("{} (process {})", text, processes->rank()));
    };
    if (processes->rank() > 0) {
        work({.until = options.until, .device = options.device, .processes = processes, .last_words = last_words});
        return kDone;
    }
    ProgressDisplay display(progress_style(options.progress));
    run::RunSettings settings;
    settings.until = options.until;
    settings.existing = options.overwrite ? run::Existing::kOverwrite : run::Existing::kRefuse;
    settings.device = options.device;
    settings.processes = processes;
    settings.on_begin = [&](const scene::Scene& scene) { print_header(scene, registry, folder, processes->size()); };
    settings.stop_signal = stop_signal;
    settings.on_progress = [&](const run::RunProgress& progress) { display.show(progress); };
    settings.log = [&](LogLevel level, std::string_view message) {
        if (level != LogLevel::kWarning) return;
        display.clear();
        fmt::print(stderr, "note: {}\n", message);
    };
    settings.last_words = last_words;
    const auto begin = std::chrono::steady_clock::now();
    const run::RunResult result = work(settings);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    display.clear();
    print_summary(result, folder, seconds);
    constexpr int kExitOnSignal = 128;
    return result.finished ? kDone : kExitOnSignal + result.signal;
}

int run_scene_command(const RunOptions& options) {
    return with_processes(options, [&](const Processes& processes) {
        const sim::SolverRegistry registry = scene::all_solvers();
        take_device(options.device, *processes);
        std::filesystem::path file;
        const scene::Scene scene = dist::together(*processes, [&] {
            file = scene::resolve_scene_path(options.scene);
            return scene::load_scene(file, options.overrides, registry);
        });
        const std::string folder = options.folder.empty() ? default_folder(file) : options.folder;
        return supervise(options, folder, registry, processes, [&](const run::RunSettings& settings) {
            return run::run_scene(scene, registry, folder, settings);
        });
    });
}

int resume_command(const RunOptions& options) {
    return with_processes(options, [&](const Processes& processes) {
        take_device(options.device, *processes);
        const sim::SolverRegistry registry = scene::all_solvers();
        return supervise(options, options.folder, registry, processes, [&](const run::RunSettings& settings) {
            return run::resume_run(options.folder, registry, settings);
        });
    });
}

}  // namespace

void add_run_commands(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<RunOptions>();
    CLI::App* run =
        add_command(app, "run", "Run a scene",
                    "  lamella run bubble/coarsening-2d-small\n"
                    "  lamella run my-foam.toml --out foam --until 50 --threads 2\n"
                    "  lamella run bubble/coarsening-2d --set bubble.gas_fraction=0.9 --out wet --overwrite\n");
    run->add_option("scene", options->scene, "Scene file, or the name of a shipped scene")
        ->required()
        ->type_name("SCENE");
    run->add_option("--out", options->folder, "Run folder; by default runs/<name of the scene>")->type_name("DIR");
    run->add_option("--set", options->overrides, "Override a value of the scene; may be repeated")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    run->add_flag("--overwrite", options->overwrite, "Replace a run that is in the folder already");
    add_common_options(*run, *options);
    run->callback([options, &exit_code] { exit_code = run_scene_command(*options); });

    auto resume_options = std::make_shared<RunOptions>();
    CLI::App* resume = add_command(app, "resume", "Continue a run from its last checkpoint",
                                   "  lamella resume foam\n"
                                   "  lamella resume foam --until 200\n");
    resume->add_option("run", resume_options->folder, "Run folder")->required()->type_name("RUN");
    add_common_options(*resume, *resume_options);
    resume->callback([resume_options, &exit_code] { exit_code = resume_command(*resume_options); });
}

}  // namespace lamella::app
