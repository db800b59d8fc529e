#include "lamella/run/detail/loop.h"

#include "lamella/core/build_info.h"
#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace lamella::run {
namespace {

std::string version_text() {
    const BuildInfo build = build_info();
    return fmt::format("lamella {} ({})", build.version, build.commit);
}

std::string time_text(double time, const std::string& unit) {
    return unit == "-" ? fmt::format("{:.6g}", time) : fmt::format("{:.6g} {}", time, unit);
}

}  // namespace

Loop::Loop(const Team& team,
           const RunFolder& folder,
           const scene::Scene& scene,
           const Schedule& schedule,
           const RunSettings& settings,
           std::unique_ptr<sim::Solver> solver)
    : team_(team),
      folder_(folder),
      scene_(scene),
      schedule_(schedule),
      settings_(settings),
      solver_(std::move(solver)),
      log_file_(folder.log()),
      provenance_(folder.provenance(), scene, settings.device, settings.processes ? settings.processes->size() : 1),
      series_(folder.series()) {
    record_.time_unit = solver_->time_unit();
    settings_.on_begin(scene_);
    for (const std::string& text : provenance_.notes()) note(text);
}

void Loop::take_up(RunState state) {
    state_ = std::move(state);
    resumed_ = true;
    series_ = Series(folder_.series(), state_.series_bytes);
    events_.emplace(folder_.events(), state_.events_bytes);
    if (!state_.frame_times.empty()) write_collection();
}

void Loop::note(const std::string& text) {
    record_.notes.push_back(text);
    log(LogLevel::kWarning, text);
}

RunResult Loop::run() {
    try {
        run_until_stopped();
    } catch (const std::exception& error) {
        record_failure(error.what());
        throw;
    }
    result_.time = solver_->time();
    result_.time_unit = solver_->time_unit();
    result_.step = solver_->step();
    result_.steps_taken = record_.steps_taken;
    result_.frames = static_cast<std::int64_t>(state_.frame_times.size());
    return result_;
}

void Loop::run_until_stopped() {
    try {
        run_to_end();
        finish("finished", result_.stop_reason);
        result_.finished = true;
    } catch (const Interrupted&) {
        result_.signal = settings_.stop_signal();
        result_.stop_reason = fmt::format("interrupted by signal {}", result_.signal);
        finish("interrupted", result_.stop_reason);
    } catch (const NumericalError& error) {
        if (!started()) throw;
        checkpoint();
        throw NumericalError(fmt::format("{} (time {}, step {}); the last good state is in {}", error.what(),
                                         time_text(solver_->time(), solver_->time_unit()), solver_->step(),
                                         folder_.checkpoint().string()));
    }
}

void Loop::run_to_end() {
    log(LogLevel::kInfo, fmt::format("{}: {} with solver {}, {} threads", version_text(),
                                     resumed_ ? "continuing" : "starting", scene_.solver, thread_count()));
    folder_.remove_frames_from(static_cast<std::int64_t>(state_.frame_times.size()));
    write_record("running", "");
    if (!resumed_) start();
    last_checkpoint_ = now();

    while (true) {
        const double time = solver_->time();
        const std::optional<std::string> reason = end_reason();
        const OutputTime due = started() ? next_output() : OutputTime{time, true};
        if (is_after(due.time, state_.output_time) && !is_after(due.time, time)) {
            write_output({due.time, due.frame || reason});
        } else if (reason && (is_after(time, state_.output_time) || solver_->step() > state_.output_step)) {
            // A solver that looks for a rest may have changed everything in no time.
            write_output({time, true});
        }
        if (reason) {
            result_.stop_reason = *reason;
            break;
        }
        if (checkpoint_is_due()) checkpoint();
        if (settings_.stop_signal() != 0) throw Interrupted();
        advance(next_output().time);
        report_progress();
    }
}

/// Frames that a slow motion would have had before it began are not made up for.
OutputTime Loop::next_output() const {
    const OutputTime regular = schedule_.next(state_.output_time);
    const double slow_motion = solver_->slow_motion();
    if (slow_motion <= 1.0) return regular;
    constexpr double kJustBefore = 1.0 - 4e-9;
    const OutputTime more = schedule_.next(std::max(state_.output_time, kJustBefore * solver_->time()), slow_motion);
    return is_after(regular.time, more.time) ? more : regular;
}

void Loop::start() {
    sim::StartContext context;
    context.progress = [&](std::string_view stage, double fraction) {
        settings_.on_progress({.stage = std::string(stage), .fraction = fraction, .time_unit = solver_->time_unit()});
    };
    context.stop_requested = [&] { return settings_.stop_signal() != 0; };
    context.log = [&](LogLevel level, std::string_view message) { log(level, std::string(message)); };
    record_.times.measure(Stage::kStart, [&] { solver_->start(context); });
}

std::optional<std::string> Loop::end_reason() const {
    if (auto reason = solver_->stop_reason()) return reason;
    if (!is_after(schedule_.end(), solver_->time()))
        return fmt::format("the end time {} is reached", time_text(schedule_.end(), solver_->time_unit()));
    return std::nullopt;
}

void Loop::write_output(OutputTime due) {
    record_.times.measure(Stage::kOutput, [&] {
        const bool shown = due.frame && scene_.output.frames;
        const sim::Frame frame = shown ? solver_->frame() : solver_->measured_frame();
        if (!events_) {
            const std::string& length = frame.points.length_unit;
            events_.emplace(
                folder_.events(),
                std::vector<std::string>{fmt::format("time[{}]", frame.time_unit), "kind", fmt::format("x[{}]", length),
                                         fmt::format("y[{}]", length), fmt::format("z[{}]", length), "detail"});
        }
        collect_events();
        series_.append(frame, team_.measure(frame));
        if (shown) write_frame(frame);
    });
    state_.output_time = due.time;
    state_.output_step = solver_->step();
}

void Loop::write_frame(const sim::Frame& frame) {
    const auto index = static_cast<std::int64_t>(state_.frame_times.size());
    team_.write_frame(folder_.path() / RunFolder::frame_name(index), frame);
    solver_->mark_frame();
    state_.frame_times.push_back(frame.time);
    write_collection();
}

void Loop::write_collection() {
    std::vector<io::FrameEntry> entries;
    for (std::size_t k = 0; k < state_.frame_times.size(); ++k)
        entries.push_back({state_.frame_times[k], RunFolder::frame_name(static_cast<std::int64_t>(k))});
    io::write_pvd(folder_.frame_collection(), entries);
}

void Loop::advance(double limit) {
    const double before = solver_->time();
    const sim::StepReport report = record_.times.measure(Stage::kAdvance, [&] { return solver_->advance(limit); });
    ++record_.steps_taken;
    record_.evaluations += report.evaluations;
    collect_events();

    // A few are a solver's right (an event takes no time), more are a dead end, unless it says that it is at work: a
    // search for a rest bounds its own steps.
    constexpr int kMostIdleSteps = 1000;
    idle_steps_ = solver_->time() > before || report.iterations > 0 ? 0 : idle_steps_ + 1;
    if (idle_steps_ > kMostIdleSteps)
        throw NumericalError(fmt::format("time stands still: {} steps in a row advanced by nothing", idle_steps_));
}

void Loop::collect_events() {
    for (const sim::Event& event : solver_->take_events()) {
        if (!events_) continue;  // of start(): they belong to the preparation
        events_->append_text({io::shortest_text(event.time), event.kind, io::shortest_text(event.position[0]),
                              io::shortest_text(event.position[1]), io::shortest_text(event.position[2]),
                              event.detail});
    }
}

bool Loop::checkpoint_is_due() const {
    const double interval = scene_.output.checkpoint_interval;
    if (!(interval > 0.0)) return false;
    // The start may have been long work: keep it at once.
    const bool just_started = !resumed_ && record_.steps_taken == 0;
    return just_started || now() - last_checkpoint_ >= interval;
}

void Loop::checkpoint() {
    record_.times.measure(Stage::kCheckpoint, [&] {
        state_.series_bytes = series_.sync();
        state_.events_bytes = events_ ? events_->sync() : 0;
        write_checkpoint(folder_.checkpoint(), scene_.solver, *solver_, state_);
    });
    last_checkpoint_ = now();
    write_record("running", "");
}

void Loop::finish(const std::string& state, const std::string& reason) {
    if (started()) checkpoint();  // inside Solver::start there is no state worth keeping
    for (const ProcessReport& process : team_.report()) {
        record_.peak_memory.push_back(process.peak_memory);
        record_.exchange_seconds.push_back(process.exchange);
    }
    write_record(state, reason);
    log(LogLevel::kInfo, fmt::format("{}: {}", state, reason));
}

void Loop::record_failure(const std::string& reason) noexcept {
    try {
        log(LogLevel::kError, reason);
        write_record("failed", reason);
    } catch (...) {
        // The disk may be full, which may be the very failure: that error is on its way to the caller.
    }
}

void Loop::write_record(const std::string& state, const std::string& reason) {
    record_.state = state;
    record_.stop_reason = reason;
    record_.time = solver_->time();
    record_.step = solver_->step();
    record_.frames = static_cast<std::int64_t>(state_.frame_times.size());
    provenance_.write(record_);
}

void Loop::report_progress() const {
    settings_.on_progress({.stage = "run",
                           .fraction = fraction_done(),
                           .time = solver_->time(),
                           .time_unit = solver_->time_unit(),
                           .step = solver_->step(),
                           .frames = static_cast<std::int64_t>(state_.frame_times.size())});
}

std::optional<double> Loop::fraction_done() const {
    std::optional<double> fraction = solver_->progress();
    // Whichever end comes first ends the run, so the further of the two counts.
    if (std::isfinite(schedule_.end()))
        fraction = std::max(fraction.value_or(0.0), std::min(1.0, solver_->time() / schedule_.end()));
    return fraction;
}

void Loop::log(LogLevel level, const std::string& message) {
    log_file_.write(level, message);
    settings_.log(level, message);
}

double Loop::now() const {
    if (settings_.wall_clock) return settings_.wall_clock();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace lamella::run
