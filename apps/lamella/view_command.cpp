#include "lamella/core/error.h"
#include "lamella/run/run_folder.h"
#include "lamella/scene/scene.h"
#include "lamella/scene/shipped.h"

#include <fmt/format.h>

#include "command_line.h"
#include "commands.h"
#include "output.h"
#include "signals.h"
#include "view/page_files.h"
#include "view/run_process.h"
#include "view/run_view.h"
#include "view/server.h"
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace lamella::app {
namespace {

struct ViewOptions {
    std::string target;
    int port = 0;
    std::string folder;
    std::vector<std::string> overrides;
    std::vector<std::string> of_run;  ///< options that are handed on to the run as they are
    bool overwrite = false;
};

constexpr std::chrono::milliseconds kPatience{50};  // between two looks at what may have changed

void check_page() {
    if (view::page_files().empty())
        throw InputError(
            "this program was built without its page; install nodejs and npm, run `npm ci --ignore-scripts` in web/ of "
            "the source tree, then build again (`./run.sh` does all of it)");
}

std::string run_folder_of(const ViewOptions& options, const std::filesystem::path& scene) {
    return options.folder.empty() ? (std::filesystem::path("runs") / scene.stem()).string() : options.folder;
}

/// Starts `lamella run` on the scene. What is wrong with the scene is said before anything is started.
std::unique_ptr<view::RunProcess> start_run(const ViewOptions& options,
                                            const std::filesystem::path& scene,
                                            const std::string& folder) {
    scene::load_scene(scene, options.overrides, scene::all_solvers());
    std::vector<std::string> words{std::filesystem::read_symlink("/proc/self/exe").string(),
                                   "run",
                                   scene.string(),
                                   "--out",
                                   folder,
                                   "--progress",
                                   "none"};
    for (const std::string& change : options.overrides) words.insert(words.end(), {"--set", change});
    if (options.overwrite) words.emplace_back("--overwrite");
    words.insert(words.end(), options.of_run.begin(), options.of_run.end());
    return std::make_unique<view::RunProcess>(words);
}

/// Waits for the run to take its folder. Nothing, or the exit code of a run that ended before it could.
int wait_for_folder(view::RunProcess& process, const std::string& folder) {
    const auto is_ours = [&] { return run::is_run_folder(folder) && std::filesystem::exists(folder + "/run.json"); };
    while (stop_signal() == 0) {
        if (const auto code = process.exit_code(); code && (*code != 0 || !is_ours())) return *code;
        if (is_ours()) return 0;
        std::this_thread::sleep_for(kPatience);
    }
    return 0;
}

int serve(const std::string& folder, view::RunProcess* process, int port) {
    const view::RunView run(folder, process);
    const std::string token = view::new_token();
    const view::Server server(run, token, port);
    print_result(fmt::format("http://127.0.0.1:{}/#token={}\n", server.port(), token));
    fmt::print(stderr, "Open this address in a browser to see {}; Ctrl-C ends it.\n", folder);
    while (stop_signal() == 0) std::this_thread::sleep_for(kPatience);
    return kDone;
}

int view_command(const ViewOptions& options) {
    check_page();
    catch_stop_signals();
    if (run::is_run_folder(options.target)) {
        if (!options.folder.empty() || !options.overrides.empty() || options.overwrite || !options.of_run.empty())
            throw InputError(
                fmt::format("{} is a run already: --out, --set, --overwrite, --until and --threads are for a scene",
                            options.target));
        return serve(options.target, nullptr, options.port);
    }
    const std::filesystem::path scene = scene::resolve_scene_path(options.target);
    if (std::filesystem::is_directory(scene))
        throw InputError(
            fmt::format("{} is neither a run folder (it has no scene.toml and run.json) nor a scene", options.target));
    const std::string folder = run_folder_of(options, scene);
    const std::unique_ptr<view::RunProcess> process = start_run(options, scene, folder);
    if (const int code = wait_for_folder(*process, folder); code != 0) return code;
    return stop_signal() != 0 ? kDone : serve(folder, process.get(), options.port);
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ViewOptions>();
    CLI::App* command = add_command(app, "view", "Show a run in the web browser, also while it goes on",
                                    "  lamella view runs/double-bubble\n"
                                    "  lamella view vortex_sheet/double-bubble-small\n"
                                    "  lamella view my-films.toml --out films --set resolution.edge_length=\"2 mm\"\n");
    command->add_option("target", options->target, "Run folder; or a scene (file or shipped), which is run")
        ->required()
        ->type_name("RUN|SCENE");
    command->add_option("--port", options->port, "Port on the loopback address; 0: any free one")
        ->check(CLI::Range(0, 65535))
        ->type_name("P");
    command->add_option("--out", options->folder, "Run folder of a scene; by default runs/<name of the scene>")
        ->type_name("DIR");
    command->add_option("--set", options->overrides, "Override a value of the scene; may be repeated")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    command->add_flag("--overwrite", options->overwrite, "Replace a run that is in the folder already");
    const auto hand_on = [options](const char* name) {
        return [options, name](const std::string& value) {
            options->of_run.insert(options->of_run.end(), {name, value});
        };
    };
    command->add_option_function<std::string>("--until", hand_on("--until"), "Stop a scene's run at this time")
        ->type_name("T");
    command->add_option_function<std::string>("--threads", hand_on("--threads"), "Worker threads of a scene's run")
        ->check(CLI::Range(0, 4096))
        ->type_name("N");
    command->callback([options, &exit_code] { exit_code = view_command(*options); });
}

}  // namespace lamella::app
