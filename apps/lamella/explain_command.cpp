#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/io/atomic_file.h"
#include "lamella/render/color_chart.h"
#include "lamella/scene/film_tables.h"
#include "lamella/scene/scene.h"
#include "lamella/sim/read_options.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "output.h"
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

namespace lamella::app {
namespace {

using sim::OptionInfo;

struct ExplainOptions {
    std::string topic;
    bool json = false;
    bool markdown = false;
    std::string out;           ///< of colors: a picture
    std::string light = "D65"; ///< of colors
};

/// A table of a scene that can be explained.
struct Topic {
    std::string name;
    std::string summary;
    std::vector<OptionInfo> options;
};

std::vector<Topic> all_topics() {
    std::vector<Topic> topics;
    const sim::SolverRegistry registry = scene::all_solvers();
    for (const sim::SolverEntry& entry : registry.entries())
        topics.push_back({entry.name, entry.summary, entry.describe()});
    topics.push_back({"time", "how long a run is and when it is looked at; in the solver's unit of time",
                      sim::describe_options<scene::TimeOptions>()});
    topics.push_back({"output", "what is written", sim::describe_options<scene::OutputOptions>()});
    for (scene::FilmTableInfo& table : scene::film_table_infos())
        topics.push_back({table.list ? "[[" + table.name + "]]" : table.name, table.summary, std::move(table.options)});
    return topics;
}

bool is_group(const OptionInfo& option) { return option.type == "group"; }

std::string facts(const OptionInfo& option) {
    std::string text = option.type;
    if (option.doc.unit != "-") text += fmt::format(" [{}]", option.doc.unit);
    if (!option.allowed.empty()) text += fmt::format(", {}", option.allowed);
    if (!option.default_text.empty()) text += fmt::format(", default {}", option.default_text);
    return text;
}

std::string option_text(const std::string& topic, const OptionInfo& option) {
    if (is_group(option)) return fmt::format("\n[{}.{}]  {}\n", topic, option.name, option.doc.text);
    std::vector<std::pair<std::string, std::string>> rows{{"", facts(option)}, {"", option.doc.text}};
    if (!option.doc.source.empty()) rows.emplace_back("", option.doc.source);
    return fmt::format("{}.{}\n", topic, option.name) + two_columns(rows);
}

std::string markdown_table(const Topic& topic) {
    const auto cell = [](std::string text) {  // a bar would end the cell
        for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
        return text;
    };
    std::string text = "| option | default | allowed | unit | meaning | source |\n|---|---|---|---|---|---|\n";
    for (const OptionInfo& option : topic.options) {
        if (is_group(option))
            text += fmt::format("| **`{}`** | | | | *{}* | |\n", option.name, cell(option.doc.text));
        else
            text += fmt::format("| `{}` | `{}` | {} | {} | {} | {} |\n", option.name, cell(option.default_text),
                                cell(option.allowed), option.doc.unit, cell(option.doc.text), cell(option.doc.source));
    }
    return text;
}

nlohmann::ordered_json option_json(const std::string& topic, const OptionInfo& option) {
    return {{"name", topic + "." + option.name}, {"type", option.type},     {"default", option.default_text},
            {"allowed", option.allowed},         {"unit", option.doc.unit}, {"text", option.doc.text},
            {"source", option.doc.source}};
}

void list_topics(const std::vector<Topic>& topics, bool json) {
    if (json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const Topic& topic : topics) list.push_back({{"name", topic.name}, {"summary", topic.summary}});
        print_result(list.dump(2) + "\n");
        return;
    }
    std::vector<std::pair<std::string, std::string>> rows;
    for (const Topic& topic : topics) rows.emplace_back(topic.name, topic.summary);
    rows.emplace_back("colors", "not a table: the colors of soap films over their thickness");
    print_result("Solvers and tables of a scene; `lamella explain NAME` shows the options:\n" + two_columns(rows));
}

const Topic& find_topic(const std::vector<Topic>& topics, const std::string& name) {
    std::vector<std::string> names;
    for (const Topic& topic : topics) {
        if (topic.name == name) return topic;
        names.push_back(topic.name);
    }
    const auto near = nearest_word(name, names);
    throw InputError(fmt::format("there is no solver or table {}{}; `lamella explain` lists them", name,
                                 near ? fmt::format("; did you mean {}?", *near) : ""));
}

/// The options of a topic that `path` names: one, or a group with everything in it; all for "".
std::vector<OptionInfo> select_options(const Topic& topic, const std::string& path) {
    std::vector<OptionInfo> selected;
    std::vector<std::string> names;
    for (const OptionInfo& option : topic.options) {
        names.push_back(option.name);
        if (path.empty() || option.name == path || option.name.starts_with(path + ".")) selected.push_back(option);
    }
    if (!selected.empty()) return selected;
    // A bare option name ("medium_ratio" for "gas.medium_ratio") is meant more often than it is mistyped.
    const auto same_leaf =
        std::find_if(names.begin(), names.end(), [&](const std::string& name) { return name.ends_with("." + path); });
    const auto near = same_leaf != names.end() ? std::optional(*same_leaf) : nearest_word(path, names);
    throw InputError(fmt::format("{} has no option {}{}; `lamella explain {}` lists them", topic.name, path,
                                 near ? fmt::format("; did you mean {}.{}?", topic.name, *near) : "", topic.name));
}

/// The colors of soap films: a picture, or a table on standard output, with swatches where it is a terminal.
void explain_colors(const ExplainOptions& options) {
    const optics::FilmLight film{.light = optics::illuminant(options.light)};
    if (!options.out.empty()) {
        if (!options.out.ends_with(".png")) throw InputError(fmt::format("{}: the chart is a .png file", options.out));
        constexpr std::size_t kWidth = 1600, kHeight = 800;
        io::write_file_atomically(options.out, io::png_bytes(render::color_chart(film, kWidth, kHeight).raster(8, 3)));
        fmt::print(stderr, "{}\n", options.out);
        return;
    }
    constexpr double kStep = 20e-9;  // [m]
    const bool swatches = ::isatty(STDOUT_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    std::string text = fmt::format("Colors of soap films in {} light, seen from straight above\n\n"
                                   "thickness  reflected  color    name\n", film.light.name);
    for (const render::ChartRow& row : render::color_rows(film, kStep)) {
        const auto& [r, g, b] = row.screen;
        const std::string color = fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
        list.push_back({{"thickness", row.thickness}, {"reflectance", row.reflectance}, {"color", color}, {"name", row.name}});
        const std::string swatch = swatches ? fmt::format("  \x1b[48;2;{};{};{}m        \x1b[0m", r, g, b) : "";
        text += fmt::format("{:6.0f} nm   {:6.2f} %  {}  {:<10}{}\n", 1e9 * row.thickness, 100.0 * row.reflectance, color, row.name, swatch);
    }
    print_result(options.json ? list.dump(2) + "\n" : text);
}

void explain(const ExplainOptions& options) {
    if (options.topic == "colors") return explain_colors(options);
    if (!options.out.empty()) throw InputError("--out belongs to `lamella explain colors`");
    const std::vector<Topic> topics = all_topics();
    if (options.topic.empty()) return list_topics(topics, options.json);

    const std::size_t dot = options.topic.find('.');
    const Topic& topic = find_topic(topics, options.topic.substr(0, dot));
    const std::string path = dot == std::string::npos ? "" : options.topic.substr(dot + 1);
    const std::vector<OptionInfo> selected = select_options(topic, path);
    if (options.markdown) return print_result(markdown_table({topic.name, topic.summary, selected}));
    if (options.json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const OptionInfo& option : selected) list.push_back(option_json(topic.name, option));
        return print_result(list.dump(2) + "\n");
    }
    std::string text = path.empty() ? fmt::format("[{}]  {}\n", topic.name, topic.summary) : "";
    for (const OptionInfo& option : selected) text += option_text(topic.name, option);
    print_result(text);
}

}  // namespace

void add_explain_command(CLI::App& app) {
    CLI::App* command = add_command(app, "explain", "Explain the options of a solver: unit, default, range, source",
                                    "  lamella explain\n"
                                    "  lamella explain bubble\n"
                                    "  lamella explain bubble.gas\n"
                                    "  lamella explain bubble.gas.medium_ratio --json\n"
                                    "  lamella explain colors --out colors.png     the colors of soap films\n");
    auto options = std::make_shared<ExplainOptions>();
    command->add_option("topic", options->topic, "Solver or table of a scene, a group of options, or one option; or colors")
        ->type_name("SOLVER[.OPTION]");
    command->add_option("--out", options->out, "Of colors: draw the chart into this file")->type_name("FILE.png");
    command->add_option("--light", options->light, "Of colors: D65 (daylight), A (bulb), E (equal energy) or \"5000 K\"")
        ->type_name("LIGHT");
    command->add_flag("--json", options->json, "Print JSON");
    command->add_flag("--markdown", options->markdown, "Print the table that the documentation uses");
    command->callback([options] { explain(*options); });
}

}  // namespace lamella::app
