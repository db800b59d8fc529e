#include "lamella/scene/import.h"

#include <fmt/format.h>

#include "command_line.h"
#include "commands.h"
#include "output.h"
#include <memory>
#include <string>

namespace lamella::app {

void add_import_command(CLI::App& app) {
    struct ImportOptions {
        std::string file;
        std::string out;
    };
    CLI::App* command = add_command(app, "import", "Turn another program's input into a scene",
                                    "  lamella import input_parameters.json --out foam.toml\n"
                                    "  lamella import input_parameters.json --out - | less\n");
    auto options = std::make_shared<ImportOptions>();
    command->add_option("file", options->file, "JSON input of the wet-foam program of [Lankinen20] or of cubble")
        ->required()
        ->type_name("FILE");
    command->add_option("--out", options->out, "Scene file to write (-: standard output)")
        ->required()
        ->type_name("SCENE");
    command->callback([options] {
        const std::string text = scene::import_foam_json(options->file);
        write_result(options->out, [&](std::ostream& out) { out << text; });
        if (options->out != "-") fmt::print(stderr, "{0}: `lamella check {0}` shows what it says\n", options->out);
    });
}

}  // namespace lamella::app
