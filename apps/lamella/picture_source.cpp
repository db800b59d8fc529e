#include "picture_source.h"

#include "lamella/core/error.h"
#include "lamella/io/mesh_files.h"
#include "lamella/scene/scene.h"
#include "lamella/scene/shipped.h"
#include "lamella/sim/film_surface.h"

#include <fmt/format.h>

#include "signals.h"

namespace lamella::app {
namespace {

namespace fs = std::filesystem;

/// What a scene looks like before its first step.
sim::Frame start_of_scene(const std::string& name) {
    const sim::SolverRegistry registry = scene::all_solvers();
    const scene::Scene scene = scene::load_scene(scene::resolve_scene_path(name), {}, registry);
    const auto solver = scene::create_solver(scene, registry);
    sim::StartContext context;
    context.stop_requested = [] { return stop_signal() != 0; };
    solver->start(context);
    return solver->frame();
}

}  // namespace

PictureSource::PictureSource(const std::string& source) : name_(fs::path(source).stem().string()) {
    const fs::path path(source);
    if (fs::is_directory(path))
        run_.emplace(path);
    else if (path.extension() == ".vtp")
        single_ = io::read_vtp(path);
    else if (io::is_film_file(path))
        single_.surface = sim::film_surface(io::read_films(path).mesh);
    else if (fs::exists(path) && path.extension() != ".toml")
        throw InputError(
            fmt::format("{}: a run folder, a scene or a .vtp, .ply, .obj or .fe file is expected", source));
    else
        single_ = start_of_scene(source);
}

std::vector<std::size_t> PictureSource::chosen(const std::string& text) const {
    if (!run_) {
        if (text != "last" && text != "all" && text != "0")
            throw InputError(fmt::format("a file, and the start of a scene, is frame 0 only; there is no {}", text));
        return {0};
    }
    if (text != "all") return {run_->frame_index(text)};
    std::vector<std::size_t> all(run_->frames().size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    if (all.empty()) throw InputError(fmt::format("{} has no frames", run_->folder().string()));
    return all;
}

std::string PictureSource::picture_name(std::size_t index) const { return run_ ? fmt::format("{:06}", index) : name_; }

}  // namespace lamella::app
