#pragma once

#include "lamella/scene/scene.h"

#include <optional>

namespace lamella::run {

/// Whether `a` lies after `b` by more than rounding (1e-9 of b).
bool is_after(double a, double b);

/// A time at which something is written. Every such time gets a row of the series; some get a frame as well.
struct OutputTime {
    double time = 0.0;  ///< in the solver's time unit
    bool frame = false;
};

/// The output times of a run: frames at k / frame_rate, rows at k / series_rate and at
/// log_start * 10^(k / series_per_decade), both at 0 and at the end.
///
/// A pure function of its arguments, so that a resumed run looks at the same times as an uninterrupted one. Times are
/// computed from k, never added up. Times of different rules that differ by no more than rounding (see is_after)
/// are one; the frame's value stands.
class Schedule {
public:
    /// @param options  the scene's [time]
    /// @param until    ends the run here instead of at options.end; must be positive
    /// @throws InputError  `until` is not positive and finite, or the rates ask for more than 1e9 outputs
    explicit Schedule(const scene::TimeOptions& options, std::optional<double> until = std::nullopt);

    /// The time the run ends; infinite when only the solver's own conditions end it.
    double end() const { return end_; }

    /// The first output time after `time` (which is itself an output time, or 0). At the end, and after it, the end.
    /// @param slow_motion  so many times as many frames
    OutputTime next(double time, double slow_motion = 1.0) const;

private:
    scene::TimeOptions options_;
    double end_;
};

}  // namespace lamella::run
