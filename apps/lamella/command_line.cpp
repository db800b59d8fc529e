#include "command_line.h"

#include "lamella/core/nearest_word.h"

#include <fmt/format.h>

#include <algorithm>

namespace lamella::app {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

/// The command that the user called, its words in front of `arguments` taken off.
const CLI::App* called_command(const CLI::App* app, std::vector<std::string>& arguments) {
    while (!arguments.empty()) {
        const std::vector<std::string> names = command_names(*app);
        if (std::find(names.begin(), names.end(), arguments.front()) == names.end()) break;
        app = app->get_subcommand(arguments.front());
        arguments.erase(arguments.begin());
    }
    return app;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
    const auto near = nearest_word(word, known);
    return near ? fmt::format("; did you mean {}?", *near) : "";
}

/// The first argument that looks like an option and that the command does not have, or "".
std::string unknown_option(const CLI::App& command, const std::vector<std::string>& arguments) {
    for (const std::string& argument : arguments) {
        const std::string name = argument.substr(0, argument.find('='));
        if (name.size() > 2 && name.starts_with("--") && command.get_option_no_throw(name) == nullptr) return name;
    }
    return "";
}

std::string one_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

}  // namespace

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& summary, const std::string& examples) {
    CLI::App* command = app.add_subcommand(name, summary);
    command->footer("Examples:\n" + examples);
    return command;
}

std::string misuse_text(const CLI::App& app, const CLI::ParseError& error, std::vector<std::string> arguments) {
    const CLI::App* command = called_command(&app, arguments);
    std::string where = command->get_name();
    for (const CLI::App* parent = command->get_parent(); parent != nullptr; parent = parent->get_parent())
        where = parent->get_name() + " " + where;
    const bool has_commands = !command_names(*command).empty();
    if (arguments.empty() && has_commands) return fmt::format("a command is missing; `{} --help` lists them", where);
    if (has_commands && !arguments.front().starts_with("-"))
        return fmt::format("there is no command {}{}; `{} --help` lists them", arguments.front(),
                           suggestion(arguments.front(), command_names(*command)), where);
    const std::string option = unknown_option(*command, arguments);
    if (!option.empty()) {
        std::vector<std::string> known;
        for (const CLI::Option* candidate : command->get_options())
            for (const std::string& long_name : candidate->get_lnames()) known.push_back("--" + long_name);
        return fmt::format("{} has no option {}{}; `{} --help` lists them", where, option, suggestion(option, known),
                           where);
    }
    return fmt::format("{}; see `{} --help`", one_line(error.what()), where);
}

}  // namespace lamella::app
