#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/io/atomic_file.h"

#include <fmt/format.h>

#include "command_line.h"
#include "commands.h"
#include "frame_source.h"
#include "output.h"
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
void export_frame(const RunReader& run, std::size_t index, const std::string& format, const std::string& path) {
    if (format == "vtp") {
        // The run's own file is the format; reading it first makes sure that a whole frame goes out.
        const sim::Frame frame = run.frame(index);
        if (path == "-") return print_result(io::read_file(run.folder() / run.frames()[index].file));
        return io::write_vtp(path, frame);
    }
    const sim::Frame frame = run.frame(index);
    write_result(path, [&](std::ostream& out) { find_format(format).write(out, frame); });
}

std::string numbered(const fs::path& folder, std::size_t index, const std::string& suffix) {
    return (folder / fmt::format("{:06}{}", index, suffix)).string();
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
        export_frame(run, index, options.format, path);
        if (path != "-") fmt::print(stderr, "{}\n", path);
        return;
    }
    if (options.out == "-") throw InputError("all frames do not fit one stream; choose one with --frame");
    const fs::path folder = options.out.empty() ? default_folder : fs::path(options.out);
    fs::create_directories(folder);
    for (std::size_t index = 0; index < run.frames().size(); ++index)
        export_frame(run, index, options.format, numbered(folder, index, suffix));
    fmt::print(stderr, "{} frames in {}\n", run.frames().size(), folder.string());
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
                                    "  lamella export foam --to csv --frame 0 --out - | head -3\n" +
                                        formats_text());
    auto options = std::make_shared<ExportOptions>();
    command->add_option("run", options->run, "Run folder")->required()->type_name("RUN");
    command->add_option("--to", options->format, "Format of the files: see below")->required()->type_name("FORMAT");
    command->add_option("--frame", options->frame, "A number, last or all")->type_name("N|last|all");
    command
        ->add_option("--out", options->out,
                     "File for one frame (-: standard output), folder for all; by default RUN/export")
        ->type_name("PATH");
    command->callback([options] {
        try {
            export_run(*options);
        } catch (const fs::filesystem_error& error) {
            throw IoError(fmt::format("{}: {}", error.path1().string(), error.code().message()));
        }
    });
}

}  // namespace lamella::app
