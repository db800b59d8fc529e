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

/// The command that the user called, or nullptr.
const CLI::App* called_command(const CLI::App& app, const std::vector<std::string>& arguments) {
    if (arguments.empty()) return nullptr;
    const std::vector<std::string> names = command_names(app);
    const bool known = std::find(names.begin(), names.end(), arguments.front()) != names.end();
    return known ? app.get_subcommand(arguments.front()) : nullptr;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
    const auto near = nearest_word(word, known);
    return near ? fmt::format("; did you mean {}?", *near) : "";
}

/// The first argument that looks like an option and that the command does not have, or "".
std::string unknown_option(const CLI::App& command, const std::vector<std::string>& arguments) {
    for (std::size_t i = 1; i < arguments.size(); ++i) {
        const std::string name = arguments[i].substr(0, arguments[i].find('='));
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

std::string misuse_text(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments) {
    if (arguments.empty()) return "a command is missing; `lamella --help` lists them";
    const CLI::App* command = called_command(app, arguments);
    if (command == nullptr && !arguments.front().starts_with("-"))
        return fmt::format("there is no command {}{}; `lamella --help` lists them", arguments.front(),
                           suggestion(arguments.front(), command_names(app)));
    const std::string where = command == nullptr ? "lamella" : "lamella " + command->get_name();
    const std::string option = unknown_option(command == nullptr ? app : *command, arguments);
    if (!option.empty()) {
        std::vector<std::string> known;
        for (const CLI::Option* candidate : (command == nullptr ? app : *command).get_options())
            for (const std::string& long_name : candidate->get_lnames()) known.push_back("--" + long_name);
        return fmt::format("{} has no option {}{}; `{} --help` lists them", where, option, suggestion(option, known),
                           where);
    }
    return fmt::format("{}; see `{} --help`", one_line(error.what()), where);
}

}  // namespace lamella::app
