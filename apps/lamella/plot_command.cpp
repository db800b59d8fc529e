#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command_line.h"
#include "commands.h"
#include "frame_source.h"
#include "output.h"
#include "plot/film_panels.h"
#include "plot/foam_panels.h"
#include "plot/gnuplot.h"
#include "plot/snapshot.h"
#include "plot/table_panel.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

namespace fs = std::filesystem;

struct PlotOptions {
    std::string run;
    std::string out;
    std::string frame = "last";
    std::string color = "radius";
    std::string panel;
    TablePlot table;
};

ColorBy color_by(const std::string& name) {
    if (name == "energy") return ColorBy::kEnergy;
    if (name == "displacement") return ColorBy::kDisplacement;
    return ColorBy::kRadius;
}

/// Some frames spread over the run, the first and the last among them; later ones are evenly spaced in ln(time).
std::vector<sim::Frame> spread_frames(const RunReader& run) {
    constexpr int kMost = 5;
    const auto& entries = run.frames();
    std::vector<std::size_t> chosen;
    if (!entries.empty()) chosen.push_back(0);
    for (int k = 0; k < kMost - 1 && entries.size() > 1; ++k) {
        const double place = static_cast<double>(k) / (kMost - 2);
        const double time = entries[1].time * std::pow(entries.back().time / entries[1].time, place);
        std::size_t nearest = 1;
        for (std::size_t i = 1; i < entries.size(); ++i)
            if (std::abs(entries[i].time - time) < std::abs(entries[nearest].time - time)) nearest = i;
        if (nearest != chosen.back()) chosen.push_back(nearest);
    }
    std::vector<sim::Frame> frames;
    for (const std::size_t index : chosen) frames.push_back(run.frame(index));
    return frames;
}

/// The panels of a run of balls in the order in which they are read; `main` of them make the one picture.
struct Panels {
    std::vector<Panel> all;
    std::vector<std::string> main;
};

Panels make_panels(Gnuplot& gnuplot, const RunReader& run, const PlotOptions& options) {
    const io::CsvTable series = run.series();
    Panels panels;
    const bool foam = series.column("mean_radius") >= 0;
    if (series.column("gas_volume") >= 0) {  // measured on films
        panels.all = film_panels(gnuplot, series);
        for (const Panel& panel : panels.all) panels.main.push_back(panel.name);
        return panels;
    }
    if (!foam) {
        panels.all = series_panels(gnuplot, series);
        for (const Panel& panel : panels.all) panels.main.push_back(panel.name);
        return panels;
    }
    const auto add = [&](std::optional<Panel> panel) {
        if (panel) panels.all.push_back(std::move(*panel));
    };
    add(growth_panel(gnuplot, series));
    add(energy_panel(gnuplot, series));
    add(avalanche_panel(gnuplot, series));
    add(count_panel(gnuplot, series));
    if (!run.frames().empty()) {
        const std::vector<sim::Frame> frames = spread_frames(run);
        add(size_panel(gnuplot, frames));
        add(homogeneity_panel(gnuplot, frames));
        add(snapshot_panel(gnuplot, run.frame(run.frame_index(options.frame)), color_by(options.color)));
    }
    panels.main = {"growth", "energy", "avalanches", "sizes", "bubbles", "snapshot"};
    return panels;
}

const Panel& find_panel(const Panels& panels, const std::string& name) {
    std::vector<std::string> names;
    for (const Panel& panel : panels.all) {
        if (panel.name == name) return panel;
        names.push_back(panel.name);
    }
    const auto near = nearest_word(name, names);
    throw InputError(fmt::format("this run has no panel {}{}; it has {}", name,
                                 near ? fmt::format("; did you mean {}?", *near) : "", fmt::join(names, ", ")));
}

void draw_alone(Gnuplot& gnuplot, const Panel& panel, const fs::path& picture) {
    constexpr int kHeight = 1000;
    gnuplot.draw(panel.script, picture, static_cast<int>(kHeight * panel.aspect), kHeight);
}

/// The main panels in one picture, in rows as square as can be.
void draw_together(Gnuplot& gnuplot, const Panels& panels, const fs::path& picture) {
    std::vector<const Panel*> chosen;
    for (const std::string& name : panels.main)
        for (const Panel& panel : panels.all)
            if (panel.name == name) chosen.push_back(&panel);
    const int count = static_cast<int>(chosen.size());
    const int columns = static_cast<int>(std::ceil(std::sqrt(count)));
    const int rows = (count + columns - 1) / columns;
    std::string script = fmt::format("set multiplot layout {},{}\n", rows, columns);
    for (const Panel* panel : chosen) script += panel->script;
    constexpr int kPanelWidth = 1000;
    constexpr int kPanelHeight = 800;
    gnuplot.draw(script + "unset multiplot\n", picture, kPanelWidth * columns, kPanelHeight * rows);
}

/// A table of a sweep, as one picture beside it.
void plot_table(const PlotOptions& options) {
    Gnuplot gnuplot;
    const Panel panel = table_panel(gnuplot, io::read_csv_text(options.run), options.table);
    const fs::path picture =
        options.out.empty() ? fs::path(options.run).replace_extension(".png") : fs::path(options.out);
    draw_alone(gnuplot, panel, picture);
    fmt::print(stderr, "{}\n", picture.string());
}

void plot(const PlotOptions& options) {
    if (fs::is_regular_file(options.run)) return plot_table(options);
    const RunReader run(options.run);
    Gnuplot gnuplot;
    const Panels panels = make_panels(gnuplot, run, options);
    if (panels.all.empty()) throw InputError(fmt::format("{} has nothing to plot yet", options.run));
    const fs::path folder = run.folder() / "plots";
    if (!options.panel.empty()) {
        const Panel& panel = find_panel(panels, options.panel);
        const fs::path picture = options.out.empty() ? folder / (panel.name + ".png") : fs::path(options.out);
        if (options.out.empty()) fs::create_directories(folder);
        draw_alone(gnuplot, panel, picture);
        fmt::print(stderr, "{}\n", picture.string());
    } else if (!options.out.empty()) {
        draw_together(gnuplot, panels, options.out);
        fmt::print(stderr, "{}\n", options.out);
    } else {
        fs::create_directories(folder);
        for (const Panel& panel : panels.all) {
            draw_alone(gnuplot, panel, folder / (panel.name + ".png"));
            fmt::print(stderr, "{}\n", (folder / (panel.name + ".png")).string());
        }
    }
}

}  // namespace

void add_plot_command(CLI::App& app) {
    CLI::App* command =
        add_command(app, "plot", "Draw the series and the frames of a run (needs gnuplot)",
                    "  lamella plot foam                                  every picture, in foam/plots\n"
                    "  lamella plot foam --out foam.svg                   the main ones in one picture\n"
                    "  lamella plot foam --panel snapshot --frame 10 --color energy --out e.png\n"
                    "  lamella plot table.csv --y growth_exponent         a table of `lamella sweep collect`\n");
    auto options = std::make_shared<PlotOptions>();
    command->add_option("run", options->run, "Run folder, or a table of a sweep")
        ->required()
        ->type_name("RUN|TABLE.csv");
    command
        ->add_option("--out", options->out, "One picture with the main panels; by default RUN/plots/*.png, TABLE.png")
        ->type_name("FILE.png|.svg");
    command
        ->add_option("--panel", options->panel,
                     "Only this one. Of a foam of balls: growth, energy, avalanches, bubbles, sizes, gas_fraction, "
                     "snapshot; of films: area, volumes, pressures, angles, accuracy, mesh")
        ->type_name("NAME");
    command->add_option("--frame", options->frame, "Frame of the snapshot: a number or last")->type_name("N|last");
    command->add_option("--color", options->color, "What colors its bubbles: radius, energy or displacement")
        ->check(CLI::IsMember({"radius", "energy", "displacement"}))
        ->type_name("FIELD");
    command->add_option("--y", options->table.y, "Of a table: the column to draw")->type_name("COLUMN");
    command
        ->add_option("--x", options->table.x, "Of a table: along which; by default time, or the first key with numbers")
        ->type_name("COLUMN");
    command->add_flag("--log-x", options->table.log_x, "Of a table: a logarithmic axis");
    command->add_flag("--log-y", options->table.log_y, "Of a table: a logarithmic axis");
    command->callback([options] {
        try {
            plot(*options);
        } catch (const fs::filesystem_error& error) {
            throw IoError(fmt::format("{}: {}", error.path1().string(), error.code().message()));
        }
    });
}

}  // namespace lamella::app
