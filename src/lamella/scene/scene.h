#pragma once

#include "lamella/sim/node.h"
#include "lamella/sim/options.h"
#include "lamella/sim/registry.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::scene {

/// [time]: how long, and when to look. Times are in the solver's time unit; where that is "s", a string with a unit
/// will do ("20 ms").
struct TimeOptions {
    double end = 0.0;                ///< 0: until the solver's own end conditions
    double frame_rate = 1.0;         ///< frames per unit of time; 0: only the first and the last
    double series_rate = 0.0;        ///< series rows per unit of time, beside those at frames; 0: none
    double series_per_decade = 0.0;  ///< rows at logarithmic times from `log_start` on, per factor of ten; 0: none
    double log_start = 0.01;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("end", end, sim::at_least(0.0),
               {"when the run ends; 0: when the solver's own end conditions say", "time"});
        option("frame_rate", frame_rate, sim::at_least(0.0),
               {"frames per unit of time; 0: only the first and the last", "1/time"});
        option("series_rate", series_rate, sim::at_least(0.0),
               {"rows of the series per unit of time, beside those at frames; 0: none", "1/time"});
        option("series_per_decade", series_per_decade, sim::between(0.0, 1e6),
               {"rows at logarithmic times from log_start on, per factor of ten; 0: none"});
        option("log_start", log_start, sim::more_than(0.0), {"first time of the logarithmic rows", "time"});
    }
};

/// [output]: what is written.
struct OutputOptions {
    double checkpoint_interval = 60.0;  ///< wall-clock seconds between checkpoints; 0: only at the end or on a signal
    bool frames = true;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("checkpoint_interval", checkpoint_interval, sim::at_least(0.0),
               {"wall-clock time between checkpoints; 0: only at the end or on a signal", "s"});
        option("frames", frames, {"write frames; the series is always written"});
    }
};

/// A checked scene file: the problem, and the options of the solver that it names.
struct Scene {
    std::string file;  ///< as the user named it, for messages
    std::string title;
    std::string solver;
    std::uint64_t seed = 1;
    TimeOptions time;
    OutputOptions output;
    sim::Node root;                  ///< everything that was written, overrides applied
    std::shared_ptr<const film::Problem> films;  ///< of a film solver, otherwise empty
    std::vector<std::string> notes;  ///< e.g. "[melp] is not used by solver bubble"
};

/// Reads and checks a scene file, applies `overrides` ("bubble.gas_fraction=0.9", each a TOML value; text that is no
/// TOML value counts as a string), and checks the options of its solver.
/// @throws InputError  with file:line, the key, what was found and what is allowed   @throws IoError
Scene load_scene(const std::filesystem::path& path,
                 const std::vector<std::string>& overrides,
                 const sim::SolverRegistry& registry);

/// The same from text (tests, fuzzing, importers); `name` stands for the file in messages.
Scene parse_scene(std::string_view text,
                  const std::string& name,
                  const std::vector<std::string>& overrides,
                  const sim::SolverRegistry& registry);

/// A file of films that a scene starts from.
struct InputFile {
    std::filesystem::path path;  ///< absolute
    std::string name;            ///< of its copy in a run folder: "film_1.fe" for the first [[film]]
};
std::vector<InputFile> film_files(const Scene& scene);

/// How a resolved scene names the files of films: where they are, or as copies beside it (film_files).
enum class FileNames { kAbsolute, kCopies };

/// The scene with every default filled in, as TOML: running it again gives the same bits. Of other files the absolute name
/// is given.
std::string resolved_toml(const Scene& scene,
                          const sim::SolverRegistry& registry,
                          FileNames file_names = FileNames::kAbsolute);

/// The solver of a scene, its options checked, not started. @param processes  that compute together; empty: one
std::unique_ptr<sim::Solver> create_solver(const Scene& scene,
                                           const sim::SolverRegistry& registry,
                                           Device device = Device::kCpu,
                                           const std::shared_ptr<dist::Communicator>& processes = nullptr);

/// Every solver of this build (solvers.cpp: one plain call each).
sim::SolverRegistry all_solvers();

}  // namespace lamella::scene
