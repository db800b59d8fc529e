#include "lamella/core/error.h"

#include <CLI/CLI.hpp>

#include "command_line.h"
#include "commands.h"
#include "output.h"
#include <csignal>
#include <exception>
#include <new>
#include <string>
#include <vector>

namespace {

using namespace lamella;

int run_program(int argc, char** argv) {
    int exit_code = app::kDone;
    CLI::App program("lamella simulates soap films, bubbles and foams.", "lamella");
    program.require_subcommand(1);
    program.footer(
        "Examples:\n"
        "  lamella run bubble/coarsening-2d-small --out foam   run a shipped scene\n"
        "  lamella plot foam                                   draw what came out\n"
        "  lamella render foam                                 a picture of the last frame\n"
        "  lamella explain bubble.gas                          what the options mean\n\n"
        "Exit codes: 0 done; 2 wrong input; 3 the run failed numerically; 4 a file could not be read or\n"
        "written; 130, 143 interrupted (a checkpoint is written first).");
    app::add_run_commands(program, exit_code);
    app::add_check_command(program);
    app::add_scenes_command(program);
    app::add_explain_command(program);
    app::add_sweep_command(program, exit_code);
    app::add_measure_command(program);
    app::add_plot_command(program);
    app::add_render_command(program, exit_code);
    app::add_view_command(program, exit_code);
    app::add_export_command(program);
    app::add_import_command(program);
    app::add_version_command(program);

    try {
        program.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        const CLI::App* called = &program;
        std::string name = "lamella";
        while (!called->get_subcommands().empty()) {
            if (called != &program) name += " " + called->get_name();
            called = called->get_subcommands().front();
        }
        app::print_result(called == &program ? program.help() : called->help(name));
    } catch (const CLI::ParseError& error) {
        app::print_error(app::misuse_text(program, error, {argv + 1, argv + argc}));
        return app::kWrongInput;
    }
    return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is noticed where it is written to
    try {
        return run_program(argc, argv);
    } catch (const lamella::InputError& error) {
        lamella::app::print_error(error.what());
        return lamella::app::kWrongInput;
    } catch (const lamella::IoError& error) {
        lamella::app::print_error(error.what());
        return lamella::app::kFileTrouble;
    } catch (const std::bad_alloc&) {
        lamella::app::print_error("there is not enough memory");
        return lamella::app::kFailed;
    } catch (const std::exception& error) {
        lamella::app::print_error(error.what());
        return lamella::app::kFailed;
    }
}
