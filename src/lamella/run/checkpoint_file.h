#pragma once

#include "lamella/sim/solver.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lamella::run {

/// What the loop itself must remember beside the solver's state.
struct RunState {
    double output_time = -1.0;        ///< the last output time that is written; negative: none yet
    std::int64_t output_step = 0;     ///< the solver's step at that output
    std::vector<double> frame_times;  ///< one per frame file
    std::uint64_t series_bytes = 0;   ///< length of series.csv at this state; what follows is of a later one
    std::uint64_t events_bytes = 0;
};

/// Writes the solver's state under "solver/" and the loop's under "run/". The checkpoint is whole or not there.
/// @throws IoError  the checkpoint present so far is untouched
void write_checkpoint(const std::filesystem::path& path,
                      const std::string& solver_name,
                      const sim::Solver& solver,
                      const RunState& state);

/// Reads it back into a fresh solver of the same scene.
/// @throws IoError      the file cannot be read
/// @throws InputError   it is no checkpoint of this solver, or damaged; `solver` may then be half loaded
RunState read_checkpoint(const std::filesystem::path& path, const std::string& solver_name, sim::Solver& solver);

}  // namespace lamella::run
