#include "lamella/scene/scene.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/io/csv.h"
#include "lamella/scene/detail/overrides.h"
#include "lamella/scene/detail/scene_file.h"
#include "lamella/scene/detail/toml_reader.h"
#include "lamella/scene/detail/toml_writer.h"
#include "lamella/scene/film_tables.h"
#include "lamella/sim/read_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace lamella::scene {
namespace {

/// The values outside of any table.
struct HeaderOptions {
    std::string title;
    std::string solver;
    std::int64_t seed = 1;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("title", title, {"one line that says what this is"});
        option("solver", solver, {"the method: one of `lamella explain`"});
        option("seed", seed, sim::at_least(0), {"of all random numbers"});
    }
};

// A run that would write more is a mistake in the units of time.
constexpr double kMostOutputs = 1e7;

std::vector<std::string> solver_names(const sim::SolverRegistry& registry) {
    std::vector<std::string> names;
    for (const sim::SolverEntry& entry : registry.entries()) names.push_back(entry.name);
    return names;
}

std::string quoted_names(const std::vector<std::string>& names) {
    if (names.empty()) return "none is built in";
    return fmt::format("known are \"{}\"", fmt::join(names, "\", \""));
}

sim::ModelUnits units_of(const sim::SolverEntry& solver) {
    return {.time = solver.time_unit == "-" ? "" : solver.time_unit};
}

/// The table `key` of a scene, an empty one where it has none.
sim::Node table_of(const Scene& scene, std::string_view key) {
    if (const sim::Node* table = scene.root.find(key)) return *table;
    return {sim::Node::Table{}, {scene.file, 0, 0}, std::string(key)};
}

/// Where a key that stands outside of every table belongs, when a solver's option has that name.
std::optional<std::string> option_named(const std::string& key,
                                        const Scene& scene,
                                        const sim::SolverRegistry& registry) {
    const sim::Node* chosen = scene.root.find("solver");
    const auto* name = chosen != nullptr ? std::get_if<std::string>(&chosen->value) : nullptr;
    const sim::SolverEntry* solver = name != nullptr ? registry.find(*name) : nullptr;
    if (solver == nullptr || !solver->describe) return std::nullopt;
    for (const sim::OptionInfo& info : solver->describe())
        if (info.name.substr(info.name.rfind('.') + 1) == key) return solver->name + "." + info.name;
    return std::nullopt;
}

/// Whether the scene's solver starts from the film tables; false where it names none.
bool wants_films(const Scene& scene, const sim::SolverRegistry& registry) {
    const sim::Node* chosen = scene.root.find("solver");
    const auto* name = chosen != nullptr ? std::get_if<std::string>(&chosen->value) : nullptr;
    const sim::SolverEntry* solver = name != nullptr ? registry.find(*name) : nullptr;
    return solver != nullptr && solver->films;
}

void refuse_unknown_keys(const Scene& scene, const sim::SolverRegistry& registry) {
    std::vector<std::string> known = solver_names(registry);
    for (const char* name : {"title", "solver", "seed", "time", "output"}) known.emplace_back(name);
    if (wants_films(scene, registry))
        for (const FilmTableInfo& table : film_table_infos()) known.push_back(table.name);
    for (const auto& [key, node] : *scene.root.table()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        std::optional<std::string> meant = option_named(key, scene, registry);
        if (!meant) meant = nearest_word(key, known);
        throw InputError(node.where, fmt::format("{} is no part of a scene; {}", node.path,
                                                 meant ? fmt::format("did you mean {}?", *meant)
                                                       : fmt::format("known are {}", fmt::join(known, ", "))));
    }
}

const sim::SolverEntry& chosen_solver(const Scene& scene, const sim::SolverRegistry& registry) {
    const std::vector<std::string> names = solver_names(registry);
    const sim::Node* node = scene.root.find("solver");
    if (node == nullptr)
        throw InputError({scene.file, 0, 0},
                         fmt::format("solver is missing; add a line such as solver = \"{}\" above the first table ({})",
                                     names.empty() ? "bubble" : names.front(), quoted_names(names)));
    if (const sim::SolverEntry* entry = registry.find(scene.solver)) return *entry;
    const auto near = nearest_word(scene.solver, names);
    throw InputError(node->where, fmt::format("solver = {} is no solver of this build; {}", sim::found_text(*node),
                                              near ? fmt::format("did you mean \"{}\"?", *near) : quoted_names(names)));
}

void read_header(Scene& scene) {
    sim::Node values{sim::Node::Table{}, scene.root.where, ""};
    for (const char* name : {"title", "solver", "seed"})
        if (const sim::Node* node = scene.root.find(name)) values.set(name, *node);
    const auto header = sim::read_options<HeaderOptions>(values);
    scene.title = header.title;
    scene.solver = header.solver;
    scene.seed = static_cast<std::uint64_t>(header.seed);
}

void check_output_count(const Scene& scene, const char* name, double rate) {
    if (scene.time.end * rate <= kMostOutputs) return;
    const sim::Node* node = scene.root.find("time")->find(name);
    throw InputError(node != nullptr ? node->where : SourceLocation{scene.file, 0, 0},
                     fmt::format("time.{} = {} gives {:.3g} outputs until time.end = {}; at most {:.0e} are allowed",
                                 name, rate, scene.time.end * rate, scene.time.end, kMostOutputs));
}

std::string directory_of(const Scene& scene) {
    const std::string directory = std::filesystem::path(scene.file).parent_path().string();
    return directory.empty() ? "." : directory;
}

std::filesystem::path absolute_path(const Scene& scene, const std::filesystem::path& file) {
    return std::filesystem::absolute(std::filesystem::path(directory_of(scene)) / file).lexically_normal();
}

/// The film tables, the names of their files as they are to be written.
FilmTables resolved_films(const Scene& scene, FileNames file_names) {
    FilmTables tables = read_film_tables(scene.root);
    const std::vector<InputFile> files = film_files(scene);
    std::size_t next = 0;
    for (FilmTable& film : tables.films)
        if (film.shape == FilmShape::kMesh) {
            const InputFile& input = files[next++];
            film.file = file_names == FileNames::kCopies ? input.name : input.path.string();
        }
    return tables;
}

/// The options of the scene's solver with every default filled in. Names of files count from the scene's folder; the
/// resolved scene will stand elsewhere, so they become absolute.
sim::Node resolved_options(const Scene& scene, const sim::SolverEntry& solver) {
    sim::Node options = solver.resolve(table_of(scene, solver.name));
    for (const sim::OptionInfo& info : solver.describe()) {
        if (info.doc.unit != "path") continue;
        sim::Node* node = &options;
        for (std::string_view rest = info.name; node != nullptr && !rest.empty();) {
            const std::size_t dot = std::min(rest.find('.'), rest.size());
            node = node->find(rest.substr(0, dot));
            rest.remove_prefix(std::min(dot + 1, rest.size()));
        }
        auto* text = node != nullptr ? std::get_if<std::string>(&node->value) : nullptr;
        if (text != nullptr && !text->empty()) *text = absolute_path(scene, *text).string();
    }
    return options;
}

/// What stands behind each line of a resolved table: unit and meaning.
detail::CommentOf comments_from(const std::vector<sim::OptionInfo>& infos) {
    std::map<std::string, std::string, std::less<>> comments;
    for (const sim::OptionInfo& info : infos) {
        const bool unit = !info.doc.unit.empty() && info.doc.unit != "-" && info.doc.unit != "path";
        std::string& comment = comments[info.name];
        if (unit) comment = fmt::format("[{}] ", info.doc.unit);
        if (info.type == "word") comment = info.allowed + "; ";
        comment += info.doc.text;
    }
    return [comments = std::move(comments)](std::string_view name) {
        const auto it = comments.find(name);
        return it == comments.end() ? std::string() : it->second;
    };
}

template <class Options>
std::string resolved_table(std::string_view name, const Options& options) {
    return detail::toml_text(name, sim::resolve_options(options), comments_from(sim::describe_options<Options>()));
}

}  // namespace

Scene load_scene(const std::filesystem::path& path,
                 const std::vector<std::string>& overrides,
                 const sim::SolverRegistry& registry) {
    return parse_scene(detail::read_scene_file(path), path.string(), overrides, registry);
}

Scene parse_scene(std::string_view text,
                  const std::string& name,
                  const std::vector<std::string>& overrides,
                  const sim::SolverRegistry& registry) {
    Scene scene;
    scene.file = name;
    scene.root = detail::read_toml(text, name);
    for (const std::string& assignment : overrides) detail::apply_override(scene.root, assignment);
    if (scene.root.table()->empty())
        throw InputError({name, 0, 0}, "the scene is empty; it needs at least a line solver = \"...\"");

    refuse_unknown_keys(scene, registry);
    read_header(scene);
    const sim::SolverEntry& solver = chosen_solver(scene, registry);
    for (const sim::SolverEntry& other : registry.entries())
        if (other.name != solver.name && scene.root.find(other.name) != nullptr &&
            !(solver.films && scene.root.find(other.name)->array() != nullptr))
            scene.notes.push_back(fmt::format("[{}] is not used by solver {}", other.name, solver.name));

    for (const auto& [table, used] : {std::pair("vortex", solver.vortices), {"solid", solver.solids}})
        if (solver.films && !used && scene.root.find(table) != nullptr)
            scene.notes.push_back(fmt::format("[[{}]] is not used by solver {}", table, solver.name));

    scene.time = sim::read_options<TimeOptions>(table_of(scene, "time"), units_of(solver));
    scene.output = sim::read_options<OutputOptions>(table_of(scene, "output"));
    check_output_count(scene, "frame_rate", scene.time.frame_rate);
    check_output_count(scene, "series_rate", scene.time.series_rate);
    if (solver.films)
        scene.films =
            std::make_shared<film::Problem>(film_problem(read_film_tables(scene.root), scene.root, scene.seed));
    if (solver.films && !solver.bubble_thickness &&
        std::any_of(scene.films->thickness.begin(), scene.films->thickness.end(), [](double t) { return t > 0.0; }))
        scene.notes.push_back(fmt::format("bubble.thickness is not used by solver {}", solver.name));
    create_solver(scene, registry);
    return scene;
}

std::vector<InputFile> film_files(const Scene& scene) {
    std::vector<InputFile> files;
    if (!scene.films) return files;
    const FilmTables tables = read_film_tables(scene.root);
    for (std::size_t k = 0; k < tables.films.size(); ++k) {
        const std::filesystem::path file = tables.films[k].file;
        if (tables.films[k].shape == FilmShape::kMesh)
            files.push_back({absolute_path(scene, file), fmt::format("film_{}{}", k + 1, file.extension().string())});
    }
    return files;
}

std::string resolved_toml(const Scene& scene, const sim::SolverRegistry& registry, FileNames file_names) {
    const sim::SolverEntry& solver = chosen_solver(scene, registry);
    const HeaderOptions header{scene.title, scene.solver, static_cast<std::int64_t>(scene.seed)};
    return resolved_table("", header) + "\n" +              //
           resolved_table("time", scene.time) + "\n" +      //
           resolved_table("output", scene.output) + "\n" +  //
           (solver.films ? film_tables_toml(resolved_films(scene, file_names), scene.films->edge_length) : "") +
           detail::toml_text(solver.name, resolved_options(scene, solver), comments_from(solver.describe()));
}

std::unique_ptr<sim::Solver> create_solver(const Scene& scene,
                                           const sim::SolverRegistry& registry,
                                           Device device,
                                           const std::shared_ptr<dist::Communicator>& processes) {
    const sim::SolverEntry& solver = chosen_solver(scene, registry);
    if (processes && processes->several() && !solver.processes)
        throw InputError(fmt::format("solver {} computes on one process, and {} were started: use --threads instead",
                                     solver.name, processes->size()));
    if (device != Device::kCpu && !solver.cuda)
        throw InputError(fmt::format("solver {} does not run on a GPU; use --device cpu", solver.name));
    const auto read_table = [directory = directory_of(scene)](const std::string& file) {
        io::CsvTable table = io::read_csv(std::filesystem::path(directory) / file);
        return sim::NumberTable{std::move(table.header), std::move(table.rows)};
    };
    return solver.create({.seed = scene.seed,
                          .end_time = scene.time.end,
                          .read_table = read_table,
                          .options = table_of(scene, solver.name),
                          .films = scene.films,
                          .device = device,
                          .processes = processes});
}

}  // namespace lamella::scene
