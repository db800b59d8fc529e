#include "lamella/scene/scene.h"
#include "lamella/scene/shipped.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "output.h"
#include <memory>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

struct CheckOptions {
    std::string scene;
    std::vector<std::string> overrides;
    bool json = false;
};

std::string with_unit(const sim::Scalar& scalar) {
    return number_text(scalar.value) + (scalar.unit == "-" ? "" : " " + scalar.unit);
}

/// The resolved scene, then its characteristic numbers as comments: the whole output is a scene file.
std::string report_text(const std::string& resolved, const std::vector<sim::Scalar>& numbers) {
    std::string text = resolved;
    if (numbers.empty()) return text;
    text += "\n# Characteristic numbers and step limits\n";
    std::size_t name_width = 0;
    std::size_t value_width = 0;
    for (const sim::Scalar& number : numbers) {
        name_width = std::max(name_width, number.name.size());
        value_width = std::max(value_width, with_unit(number).size());
    }
    for (const sim::Scalar& number : numbers)
        text += fmt::format("#   {:<{}}  {:>{}}  {}\n", number.name, name_width, with_unit(number), value_width,
                            number.text);
    return text;
}

std::string report_json(const scene::Scene& scene,
                        const std::string& resolved,
                        const std::vector<sim::Scalar>& numbers) {
    nlohmann::ordered_json values = nlohmann::ordered_json::object();
    for (const sim::Scalar& number : numbers)
        values[number.name] = {{"value", number.value}, {"unit", number.unit}, {"text", number.text}};
    const nlohmann::ordered_json object{{"file", scene.file},     {"title", scene.title},
                                        {"solver", scene.solver}, {"seed", scene.seed},
                                        {"notes", scene.notes},   {"characteristic_numbers", values},
                                        {"resolved", resolved}};
    return object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void check_scene(const CheckOptions& options) {
    const sim::SolverRegistry registry = scene::all_solvers();
    const scene::Scene scene = scene::load_scene(scene::resolve_scene_path(options.scene), options.overrides, registry);
    const auto solver = scene::create_solver(scene, registry);
    const std::string resolved = scene::resolved_toml(scene, registry);
    const std::vector<sim::Scalar> numbers = solver->characteristic_numbers();
    for (const std::string& note : scene.notes) fmt::print(stderr, "note: {}\n", note);
    print_result(options.json ? report_json(scene, resolved, numbers) : report_text(resolved, numbers));
}

}  // namespace

void add_check_command(CLI::App& app) {
    CLI::App* command = add_command(app, "check", "Check a scene; print it with every default, and its numbers",
                                    "  lamella check my-foam.toml\n"
                                    "  lamella check bubble/coarsening-2d --set bubble.count=1e6 --json\n");
    auto options = std::make_shared<CheckOptions>();
    command->add_option("scene", options->scene, "Scene file, or the name of a shipped scene")
        ->required()
        ->type_name("SCENE");
    command->add_option("--set", options->overrides, "Override a value of the scene; may be repeated")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    command->add_flag("--json", options->json, "Print one JSON object");
    command->callback([options] { check_scene(*options); });
}

}  // namespace lamella::app
