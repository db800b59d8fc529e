#include "lamella/core/error.h"

#include "command_line.h"
#include "commands.h"

// Linked instead of view_command.cpp where cpp-httplib was missing when lamella was built.

namespace lamella::app {

void add_view_command(CLI::App& app, int&) {
    CLI::App* command = app.add_subcommand("view", "Show a run in the web browser (not in this build)");
    command->allow_extras();
    command->callback([] {
        throw InputError("this program was built without `lamella view`; install libcpp-httplib-dev and build again");
    });
}

}  // namespace lamella::app
