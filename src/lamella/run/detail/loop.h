#pragma once

#include "lamella/io/csv.h"
#include "lamella/run/checkpoint_file.h"
#include "lamella/run/detail/team.h"
#include "lamella/run/log_file.h"
#include "lamella/run/provenance.h"
#include "lamella/run/run.h"
#include "lamella/run/schedule.h"
#include "lamella/run/series.h"

#include <memory>
#include <optional>
#include <string>

namespace lamella::run {

/// The loop of one process over one run: advance, write what is due, checkpoint, until the end or a signal.
///
/// Between two passes everything due at the solver's time is written; only such states become checkpoints. That and
/// the file lengths in the checkpoint are what makes a resumed run write the same files.
class Loop {
public:
    /// A solver of the team that has not started. What is given by reference must outlive the loop.
    Loop(const Team& team,
         const RunFolder& folder,
         const scene::Scene& scene,
         const Schedule& schedule,
         const RunSettings& settings,
         std::unique_ptr<sim::Solver> solver);

    /// The solver was loaded from a checkpoint with this state: brings the files back to it.
    void take_up(RunState state);
    /// Records a remark in log.txt and run.json.
    void note(const std::string& text);
    /// @throws  as run_scene
    RunResult run();

private:
    void run_until_stopped();
    void run_to_end();
    OutputTime next_output() const;
    void start();
    bool started() const { return state_.output_time >= 0.0; }
    std::optional<std::string> end_reason() const;
    void write_output(OutputTime due);
    void write_frame(const sim::Frame& frame);
    void write_collection();
    void advance(double limit);
    void collect_events();
    void checkpoint();
    bool checkpoint_is_due() const;
    void report_progress() const;
    std::optional<double> fraction_done() const;

    void finish(const std::string& state, const std::string& reason);
    void record_failure(const std::string& reason) noexcept;
    void write_record(const std::string& state, const std::string& reason);
    void log(LogLevel level, const std::string& message);
    double now() const;

    const Team& team_;
    const RunFolder& folder_;
    const scene::Scene& scene_;
    Schedule schedule_;
    const RunSettings& settings_;
    std::unique_ptr<sim::Solver> solver_;

    LogFile log_file_;
    Provenance provenance_;
    RunRecord record_;
    RunResult result_;

    RunState state_;
    bool resumed_ = false;
    Series series_;
    std::optional<io::CsvWriter> events_;
    double last_checkpoint_ = 0.0;  ///< now() when it was written
    int idle_steps_ = 0;            ///< in a row that left the time where it was
};

}  // namespace lamella::run
