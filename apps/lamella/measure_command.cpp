#include "lamella/core/error.h"
#include "lamella/measure/measure.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "commands.h"
#include "frame_source.h"
#include "output.h"
#include <filesystem>
#include <limits>
#include <memory>
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
std::vector<sim::Scalar> all_values(const sim::Frame& frame) {
    std::vector<sim::Scalar> values = frame.scalars;
    for (sim::Scalar& measured : measure::measure_frame(frame))
        if (!measure::find_value(values, measured.name)) values.push_back(std::move(measured));
    return values;
}

/// Puts "energy" and "energy_kinetic" into energy{total, kinetic}, "stress_xy" into stress{xy}; the rest stays flat.
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
    object[name] = value;  // a value that is not a number becomes null
}

std::string json_text(const sim::Frame& frame, const std::vector<sim::Scalar>& values) {
    ordered_json object{{"solver", frame.solver}, {"time", frame.time}, {"step", frame.step}};
    for (const sim::Scalar& value : values) add_value(object, value.name, value.value);
    return object.dump(2) + "\n";
}

std::string table_text(const sim::Frame& frame, const std::vector<sim::Scalar>& values) {
    std::string text = fmt::format("solver {}, time {:.6g}{}, step {}\n", frame.solver, frame.time,
                                   frame.time_unit == "-" ? "" : " " + frame.time_unit, frame.step);
    std::size_t name_width = 0;
    for (const sim::Scalar& value : values) name_width = std::max(name_width, value.name.size());
    for (const sim::Scalar& value : values) {
        const std::string unit = value.unit == "-" ? "" : value.unit;
        std::string line = fmt::format("  {:<{}}  {:>14} {:<6}  {}", value.name, name_width, number_text(value.value),
                                       unit, value.text);
        while (line.ends_with(' ')) line.pop_back();
        text += line + "\n";
    }
    return text;
}

void measure(const MeasureOptions& options) {
    sim::Frame frame;
    std::optional<double> exponent;
    if (std::filesystem::is_directory(options.source)) {
        const RunReader run(options.source);
        frame = run.frame(run.frame_index(options.frame));
        exponent = exponent_at(run, frame.time);
    } else {
        frame = io::read_vtp(options.source);
    }
    std::vector<sim::Scalar> values = all_values(frame);
    if (exponent) values.push_back({"exponent", "-", *exponent, "d ln<R> / d ln(time) over the last half of the time"});
    print_result(options.json ? json_text(frame, values) : table_text(frame, values));
}

}  // namespace

void add_measure_command(CLI::App& app) {
    CLI::App* command = add_command(app, "measure", "Measure a frame of a run, or a frame file",
                                    "  lamella measure foam\n"
                                    "  lamella measure foam --frame 10 --json\n"
                                    "  lamella measure foam/frames/000003.vtp\n");
    auto options = std::make_shared<MeasureOptions>();
    command->add_option("source", options->source, "Run folder or .vtp file")->required()->type_name("RUN|FILE");
    command->add_option("--frame", options->frame, "Which frame of a run: a number or last")->type_name("N|last");
    command->add_flag("--json", options->json, "Print one JSON object");
    command->callback([options] { measure(*options); });
}

}  // namespace lamella::app
