#include "lamella/core/error.h"
#include "lamella/measure/film_measures.h"
#include "lamella/measure/measure.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "film_report.h"
#include "frame_source.h"
#include "output.h"
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

using nlohmann::ordered_json;

struct MeasureOptions {
    std::string source;
    std::string frame = "last";
    bool json = false;
};

/// The local growth exponent that the series of a run has at `time`; nothing where the series has none.
std::optional<double> exponent_at(const RunReader& run, double time) {
    const io::CsvTable series = run.series();
    const auto times = find_column(series, "time");
    const auto exponents = find_column(series, "exponent");
    if (!times || !exponents) return std::nullopt;
    std::optional<double> exponent;
    for (std::size_t i = 0; i < times->size() && (*times)[i] <= time; ++i) exponent = (*exponents)[i];
    return exponent;
}

/// What the solver reported and what can be measured, each under one name.
struct Values {
    std::vector<sim::Scalar> scalars;
    std::optional<measure::FilmMeasures> films;
    std::optional<std::size_t> intersections;
};

Values all_values(const sim::Frame& frame) {
    Values values{frame.scalars, measure::film_measures(frame), measure::film_intersections(frame)};
    if (values.films) return values;
    for (sim::Scalar& measured : measure::measure_frame(frame))
        if (!measure::find_value(values.scalars, measured.name)) values.scalars.push_back(std::move(measured));
    return values;
}

/// Puts "energy" and "energy_kinetic" into energy{total, kinetic}, "surface_energy" into energy{surface}, "stress_xy"
/// into stress{xy}; the rest stays flat.
void add_value(ordered_json& object, const std::string& name, double value) {
    for (const std::string group : {"energy", "stress"}) {
        if (name == group) {
            object[group]["total"] = value;
            return;
        }
        if (name.starts_with(group + "_")) {
            object[group][name.substr(group.size() + 1)] = value;
            return;
        }
    }
    if (name.ends_with("_energy")) object["energy"][name.substr(0, name.size() - 7)] = value;
    else object[name] = value;  // a value that is not a number becomes null
}

std::string json_text(const sim::Frame& frame, const Values& values) {
    ordered_json object{{"solver", frame.solver}, {"time", frame.time}, {"step", frame.step}};
    for (const sim::Scalar& value : values.scalars) add_value(object, value.name, value.value);
    if (values.films) add_films(object, *values.films, values.intersections);
    return object.dump(2) + "\n";
}

std::string table_text(const sim::Frame& frame, const Values& values) {
    std::string text = fmt::format("solver {}, time {:.6g}{}, step {}\n", frame.solver, frame.time,
                                   frame.time_unit == "-" ? "" : " " + frame.time_unit, frame.step);
    std::size_t name_width = 0;
    for (const sim::Scalar& value : values.scalars) name_width = std::max(name_width, value.name.size());
    for (const sim::Scalar& value : values.scalars) {
        const std::string unit = value.unit == "-" ? "" : value.unit;
        std::string line = fmt::format("  {:<{}}  {:>14} {:<6}  {}", value.name, name_width, number_text(value.value),
                                       unit, value.text);
        while (line.ends_with(' ')) line.pop_back();
        text += line + "\n";
    }
    if (values.films) text += film_table(*values.films, values.intersections);
    return text;
}

std::string standard_input() {
    std::string text{std::istreambuf_iterator<char>(std::cin), {}};
    if (std::cin.bad()) throw IoError("cannot read standard input");
    return text;
}

void measure(const MeasureOptions& options) {
    sim::Frame frame;
    std::optional<double> exponent;
    if (std::filesystem::is_directory(options.source)) {
        const RunReader run(options.source);
        frame = run.frame(run.frame_index(options.frame));
        exponent = exponent_at(run, frame.time);
    } else if (options.source == "-") {
        frame = io::parse_vtp(standard_input(), "standard input");
    } else {
        frame = io::read_vtp(options.source);
    }
    Values values = all_values(frame);
    if (exponent)
        values.scalars.push_back({"exponent", "-", *exponent, "d ln<R> / d ln(time) over the last half of the time"});
    print_result(options.json ? json_text(frame, values) : table_text(frame, values));
}

}  // namespace

void add_measure_command(CLI::App& app) {
    CLI::App* command = add_command(app, "measure", "Measure a frame of a run, or a frame file",
                                    "  lamella measure foam\n"
                                    "  lamella measure foam --frame 10 --json\n"
                                    "  lamella measure foam/frames/000003.vtp\n"
                                    "  cat foam/frames/000003.vtp | lamella measure - --json\n");
    auto options = std::make_shared<MeasureOptions>();
    command->add_option("source", options->source, "Run folder or .vtp file; - for standard input")->required()->type_name("RUN|FILE");
    command->add_option("--frame", options->frame, "Which frame of a run: a number or last")->type_name("N|last");
    command->add_flag("--json", options->json, "Print one JSON object");
    command->callback([options] { measure(*options); });
}

}  // namespace lamella::app
