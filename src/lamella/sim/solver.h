#pragma once

#include "lamella/core/log.h"
#include "lamella/core/vec.h"
#include "lamella/sim/archive.h"
#include "lamella/sim/frame.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::sim {

/// What one call of Solver::advance did.
struct StepReport {
    double step = 0.0;             ///< time advanced, in the solver's time unit
    std::int64_t evaluations = 0;  ///< of the right-hand side, rejected steps included
    std::int64_t iterations = 0;   ///< of inner linear or nonlinear solves
    double residual = 0.0;         ///< of those, or the error estimate of the step
};

/// Something that happened at one moment: a bubble vanished, two merged, a film burst.
struct Event {
    double time = 0.0;
    std::string kind;    ///< t1, merge, pinch, split, pop, burst, remove, rebuild ...
    Vec3 position;       ///< where
    std::string detail;  ///< free text, e.g. "bubble 4711"
};

/// What a solver may use while it starts: report progress, notice that the user wants to stop, write a message.
struct StartContext {
    std::function<void(std::string_view stage, double fraction)> progress = [](std::string_view, double) {};
    std::function<bool()> stop_requested = [] { return false; };
    LogSink log = [](LogLevel, std::string_view) {};
};

/// A method and its state. A fresh solver has checked its options but done no work; `start` builds the initial
/// state, or `load` takes one from a checkpoint; then `advance` is called until `stop_reason` or the end time.
///
/// The same scene and seed give the same bits on any number of threads; save and load in the middle change nothing.
///
/// Where several processes compute together (SolverInput::processes), each has a Solver for its share of the items.
/// Then start, advance, frame, scalars, save and load are collective: all processes call them in the same order with
/// the same arguments. frame() shows the process's share, in an order of which each process has one stretch; scalars
/// are those of the whole; events are complete on process 0; everything else is the same everywhere.
class Solver {
public:
    virtual ~Solver() = default;

    /// Builds the initial state (packing, relaxation ...). @throws Interrupted when stop_requested says so
    virtual void start(const StartContext& context) = 0;

    /// Takes one step that does not pass `time_limit`; lands on it exactly when it would come close.
    /// @throws NumericalError  the state is that of the last completed step
    virtual StepReport advance(double time_limit) = 0;

    virtual double time() const = 0;
    virtual std::string time_unit() const { return "s"; }
    virtual std::int64_t step() const = 0;
    /// Why the simulation is over before its end time ("300 bubbles are left"), or nothing.
    virtual std::optional<std::string> stop_reason() const { return std::nullopt; }
    /// How far the run is on its way to its own end conditions, 0 to 1, or nothing: for the progress display.
    virtual std::optional<double> progress() const { return std::nullopt; }

    /// How many times as many frames as asked for are due now, because much happens: 15 while a film bursts.
    virtual double slow_motion() const { return 1.0; }

    /// Everything that can be seen now. `mark` true: displacements 'since the last frame' count from here.
    virtual Frame frame() const = 0;
    /// Enough for the measures, where no frame is written: as frame(), but points may come in any order, and fields
    /// that no measure reads may be missing.
    virtual Frame measured_frame() const { return frame(); }
    virtual void mark_frame() {}
    /// What only the solver knows, as in Frame::scalars; cheap enough for every row of the series.
    virtual std::vector<Scalar> scalars() const = 0;
    /// Events since the last call.
    virtual std::vector<Event> take_events() { return {}; }
    /// The characteristic numbers and step limits that `lamella check` prints; needs no start().
    virtual std::vector<Scalar> characteristic_numbers() const { return {}; }

    virtual void save(StateWriter& out) const = 0;
    virtual void load(StateReader& in) = 0;
};

}  // namespace lamella::sim
