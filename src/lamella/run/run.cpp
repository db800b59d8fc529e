#include "lamella/run/run.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/mesh_files.h"
#include "lamella/run/detail/loop.h"
#include "lamella/run/detail/team.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace lamella::run {
namespace {

/// A solver ready to go on, and where the loop was; no state when it must start from the scene.
struct Resumption {
    std::unique_ptr<sim::Solver> solver;
    std::optional<RunState> state;
    std::string note;  ///< what is worth telling, or ""
};

Device device_of(const RunSettings& settings) { return settings.device == "cuda" ? Device::kCuda : Device::kCpu; }

/// Whether this process only follows another.
bool follows(const RunSettings& settings) { return settings.processes && settings.processes->rank() > 0; }

Resumption read_last_checkpoint(const RunFolder& folder,
                                const scene::Scene& scene,
                                Team& team,
                                const MakeSolver& make) {
    std::string damage;
    for (const std::filesystem::path& file : {folder.checkpoint(), folder.previous_checkpoint()}) {
        if (!std::filesystem::exists(file)) continue;
        try {
            auto solver = team.create(make);
            RunState state = read_checkpoint(file, scene.solver, *solver);
            return {std::move(solver), std::move(state),
                    damage.empty() ? "" : damage + "; continued from the checkpoint before it"};
        } catch (const InputError& error) {
            if (damage.empty()) damage = error.what();
        }
    }
    if (!damage.empty()) throw InputError(damage);
    return {team.create(make), std::nullopt, "there was no checkpoint yet: started over"};
}

}  // namespace

RunResult run_scene(const scene::Scene& scene,
                    const sim::SolverRegistry& registry,
                    const std::filesystem::path& path,
                    const RunSettings& settings) {
    const MakeSolver make = [&](const std::shared_ptr<dist::Communicator>& processes) {
        return scene::create_solver(scene, registry, device_of(settings), processes);
    };
    if (follows(settings)) {
        follow(settings.processes, settings.last_words, make);
        return {};
    }
    Team team(settings.processes, settings.last_words);
    // What can be wrong with the input is found before anything is written.
    auto solver = team.create(make);
    const std::string resolved = scene::resolved_toml(scene, registry, scene::FileNames::kCopies);
    // A run keeps copies of the films it starts from, so that it can be resumed and repeated wherever it is. They are
    // read before the folder is cleared: they may be in it.
    std::vector<std::pair<std::string, std::string>> copies;
    for (const scene::InputFile& file : scene::film_files(scene))
        copies.emplace_back(file.name, io::film_file_contents(file.path));
    const Schedule schedule(scene.time, settings.until);

    RunFolder folder = RunFolder::create(path, settings.existing);
    try {
        for (const auto& [name, contents] : copies) io::write_file_atomically(folder.path() / name, contents);
        io::write_file_atomically(folder.scene(), resolved);
    } catch (...) {
        folder.discard_if_empty();
        throw;
    }
    return Loop(team, folder, scene, schedule, settings, std::move(solver)).run();
}

RunResult resume_run(const std::filesystem::path& path,
                     const sim::SolverRegistry& registry,
                     const RunSettings& settings) {
    if (follows(settings)) {
        std::optional<scene::Scene> scene;
        follow(settings.processes, settings.last_words, [&](const std::shared_ptr<dist::Communicator>& processes) {
            if (!scene) scene = scene::load_scene(path / "scene.toml", {}, registry);
            return scene::create_solver(*scene, registry, device_of(settings), processes);
        });
        return {};
    }
    Team team(settings.processes, settings.last_words);
    const RunFolder folder = RunFolder::open(path);
    const scene::Scene scene = scene::load_scene(folder.scene(), {}, registry);
    const Schedule schedule(scene.time, settings.until);
    const MakeSolver make = [&](const std::shared_ptr<dist::Communicator>& processes) {
        return scene::create_solver(scene, registry, device_of(settings), processes);
    };
    Resumption from = read_last_checkpoint(folder, scene, team, make);

    if (settings.until && is_after(from.solver->time(), *settings.until))
        throw InputError(fmt::format("{} is at time {:.6g} already, beyond {:.6g}", path.string(), from.solver->time(),
                                     *settings.until));

    Loop loop(team, folder, scene, schedule, settings, std::move(from.solver));
    if (!from.note.empty()) loop.note(from.note);
    if (from.state) loop.take_up(std::move(*from.state));
    return loop.run();
}

}  // namespace lamella::run
