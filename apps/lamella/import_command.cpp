#include "lamella/io/mesh_files.h"
#include "lamella/scene/import.h"

#include <fmt/format.h>

#include "command_line.h"
#include "commands.h"
#include "output.h"
#include <filesystem>
#include <memory>
#include <string>

namespace lamella::app {

namespace {

std::string imported_scene(const std::string& file, const std::string& out) {
    if (!io::is_film_file(file)) return scene::import_foam_json(file);
    if (out == "-") return scene::import_films(file, {});
    return scene::import_films(file, std::filesystem::absolute(out).parent_path());
}

}  // namespace

void add_import_command(CLI::App& app) {
    struct ImportOptions {
        std::string file;
        std::string out;
    };
    CLI::App* command = add_command(app, "import", "Turn another program's input into a scene",
                                    "  lamella import input_parameters.json --out foam.toml\n"
                                    "  lamella import input_parameters.json --out - | less\n"
                                    "  lamella import cube.fe --out cube.toml && lamella run cube.toml\n"
                                    "  lamella import film.obj --out film.toml\n");
    auto options = std::make_shared<ImportOptions>();
    command->add_option("file", options->file, "JSON input of the wet-foam program of [Lankinen20] or of cubble; films as Surface Evolver datafile"
                        " (.fe), OBJ or PLY")
        ->required()
        ->type_name("FILE");
    command->add_option("--out", options->out, "Scene file to write (-: standard output)")
        ->required()
        ->type_name("SCENE");
    command->callback([options] {
        const std::string text = imported_scene(options->file, options->out);
        write_result(options->out, [&](std::ostream& out) { out << text; });
        if (options->out != "-") fmt::print(stderr, "{0}: `lamella check {0}` shows what it says\n", options->out);
    });
}

}  // namespace lamella::app
