#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/io/atomic_file.h"
#include "lamella/render/baked_frame.h"

#include <fmt/format.h>

#include "command_line.h"
#include "commands.h"
#include "frame_source.h"
#include "output.h"
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace lamella::app {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
    std::string run;
    std::string format;
    std::string frame = "all";
    std::string out;
    bool baked = false;
    std::string field;
    double rate = 0.0;
};

const io::FrameFormat& find_format(const std::string& name) {
    std::vector<std::string> names;
    for (const io::FrameFormat& format : io::frame_formats()) {
        if (format.name == name) return format;
        names.push_back(format.name);
    }
    std::string list = "vtp";
    for (const std::string& known : names) list += ", " + known;
    names.emplace_back("vtp");
    const auto near = nearest_word(name, names);
    throw InputError(fmt::format("there is no format {}{}; the formats are {}", name,
                                 near ? fmt::format("; did you mean {}?", *near) : "", list));
}

/// Writes one frame to `path`, or to standard output where that is "-".
void export_frame(const RunReader& run, std::size_t index, const ExportOptions& options, const std::string& path) {
    const std::string& format = options.format;
    const bool baked = options.baked || !options.field.empty();
    if (format == "vtp" && !baked) {
        // The run's own file is the format; reading it first makes sure that a whole frame goes out.
        const sim::Frame frame = run.frame(index);
        if (path == "-") return print_result(io::read_file(run.folder() / run.frames()[index].file));
        return io::write_vtp(path, frame);
    }
    sim::Frame frame = run.frame(index);
    if (format == "vtp") {
        if (path == "-") throw InputError("baked frames as vtp go to files; choose one with --out");
        return io::write_vtp(path, render::baked_frame(frame, options.field));
    }
    const io::FrameFormat& chosen = find_format(format);
    if (baked || chosen.for_drawing) frame = render::baked_frame(frame, options.field);
    write_result(path, [&](std::ostream& out) { chosen.write(out, frame); });
}

std::string numbered(const fs::path& folder, std::size_t index, const std::string& suffix) {
    return (folder / fmt::format("{:06}{}", index, suffix)).string();
}

/// All frames, or with a rate those nearest to the times first + k / rate: other programs play sequences evenly.
std::vector<std::size_t> chosen_frames(const RunReader& run, double rate) {
    const std::vector<io::FrameEntry>& frames = run.frames();
    std::vector<std::size_t> chosen;
    if (rate == 0.0 || frames.empty()) {
        for (std::size_t i = 0; i < frames.size(); ++i) chosen.push_back(i);
        return chosen;
    }
    const double first = frames.front().time, span = frames.back().time - first;
    if (span * rate > 1e6)
        throw InputError(fmt::format("--rate {:g} makes {:.3g} frames; at most 1e6 are written", rate, span * rate));
    for (std::size_t k = 0, i = 0; static_cast<double>(k) <= span * rate * (1.0 + 1e-9); ++k) {
        const double time = first + static_cast<double>(k) / rate;
        while (i + 1 < frames.size() && std::abs(frames[i + 1].time - time) <= std::abs(frames[i].time - time)) ++i;
        chosen.push_back(i);
    }
    return chosen;
}

void export_run(const ExportOptions& options) {
    const std::string suffix = options.format == "vtp" ? ".vtp" : find_format(options.format).suffix;
    const RunReader run(options.run);
    const fs::path default_folder = run.folder() / "export";

    if (options.frame != "all") {
        const std::size_t index = run.frame_index(options.frame);
        std::string path = options.out;
        if (path.empty()) {
            fs::create_directories(default_folder);
            path = numbered(default_folder, index, suffix);
        }
        export_frame(run, index, options, path);
        if (path != "-") fmt::print(stderr, "{}\n", path);
        return;
    }
    if (options.out == "-") throw InputError("all frames do not fit one stream; choose one with --frame");
    const fs::path folder = options.out.empty() ? default_folder : fs::path(options.out);
    fs::create_directories(folder);
    const std::vector<std::size_t> chosen = chosen_frames(run, options.rate);
    for (std::size_t k = 0; k < chosen.size(); ++k) export_frame(run, chosen[k], options, numbered(folder, k, suffix));
    fmt::print(stderr, "{} frames in {}\n", chosen.size(), folder.string());
}

std::string formats_text() {
    std::vector<std::pair<std::string, std::string>> rows{{"vtp", "VTK PolyData, as in the run: ParaView"}};
    for (const io::FrameFormat& format : io::frame_formats()) rows.emplace_back(format.name, format.summary);
    return "Formats:\n" + two_columns(rows);
}

}  // namespace

void add_export_command(CLI::App& app) {
    CLI::App* command = add_command(app, "export", "Write frames of a run in another format",
                                    "  lamella export foam --to xyz --out foam-xyz\n"
                                    "  lamella export foam --to ply --frame last --out last.ply\n"
                                    "  lamella export foam --to csv --frame 0 --out - | head -3\n"
                                    "  lamella export films --to ply --baked --rate 240    a sequence for Blender\n" +
                                        formats_text());
    auto options = std::make_shared<ExportOptions>();
    command->add_option("run", options->run, "Run folder")->required()->type_name("RUN");
    command->add_option("--to", options->format, "Format of the files: see below")->required()->type_name("FORMAT");
    command->add_option("--frame", options->frame, "A number, last or all")->type_name("N|last|all");
    command
        ->add_option("--out", options->out,
                     "File for one frame (-: standard output), folder for all; by default RUN/export")
        ->type_name("PATH");
    command->add_flag(
        "--baked", options->baked,
        "For drawing: films cut apart along borders, with normals, thickness [nm] (assumed where it is not known, "
        "as by render) and color; glb and usda always are");
    command->add_option("--field", options->field, "Bake colors of this field instead of those of light")
        ->type_name("NAME");
    command
        ->add_option("--rate", options->rate,
                     "Frames per unit of simulated time, the nearest of each; by default all there are")
        ->check(CLI::Range(1e-9, 1e12))
        ->type_name("R");
    command->callback([options] {
        try {
            export_run(*options);
        } catch (const fs::filesystem_error& error) {
            throw IoError(fmt::format("{}: {}", error.path1().string(), error.code().message()));
        }
    });
}

}  // namespace lamella::app
