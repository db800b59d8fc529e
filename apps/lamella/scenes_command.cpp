#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/scene/shipped.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "output.h"
#include <memory>
#include <string>

namespace lamella::app {
namespace {

struct ScenesOptions {
    std::string name;
    bool json = false;
};

void list_scenes(bool json) {
    const std::vector<scene::ShippedScene> scenes = scene::shipped_scenes();
    if (scenes.empty()) throw IoError("no shipped scenes were found; set LAMELLA_SCENES to their folder");
    if (json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const auto& entry : scenes)
            list.push_back({{"name", entry.name}, {"title", entry.title}, {"path", entry.path.string()}});
        print_result(list.dump(2) + "\n");
        return;
    }
    std::vector<std::pair<std::string, std::string>> rows;
    for (const auto& entry : scenes) rows.emplace_back(entry.name, entry.title);
    print_result(two_columns(rows));
}

}  // namespace

void add_scenes_command(CLI::App& app) {
    CLI::App* command = add_command(app, "scenes", "List the shipped scenes, or print one",
                                    "  lamella scenes\n"
                                    "  lamella scenes bubble/coarsening-2d > my-foam.toml\n");
    auto options = std::make_shared<ScenesOptions>();
    command->add_option("name", options->name, "Print this scene")->type_name("NAME");
    command->add_flag("--json", options->json, "Print the list as JSON");
    command->callback([options] {
        if (options->name.empty())
            list_scenes(options->json);
        else
            print_result(io::read_file(scene::resolve_scene_path(options->name)));
    });
}

}  // namespace lamella::app
