#pragma once

#include <deque>
#include <optional>
#include <string>

namespace lamella {

/// How fast work goes and how long it will take, from reports of the fraction done. Pure arithmetic on the times that
/// it is given: it reads no clock and shows nothing.
///
/// The rate is that of the last third of the time so far (at least kShortestWindow), so that it follows a run whose
/// steps grow cheaper or dearer and still does not jump.
class ProgressEstimate {
public:
    static constexpr double kShortestWindow = 5.0;  ///< [s]

    /// At `seconds` since the start, `fraction` (0 to 1) of the work is done. Times must not decrease; a fraction
    /// that falls back (the work turned out to be more) starts the estimate afresh.
    void update(double seconds, double fraction);

    double fraction() const { return samples_.empty() ? 0.0 : samples_.back().fraction; }
    /// Fraction per second [1/s], or nothing while two reports with some progress between them are missing.
    std::optional<double> rate() const;
    /// Time until the fraction is 1 [s], or nothing while the rate is unknown.
    std::optional<double> seconds_left() const;

private:
    struct Sample {
        double seconds;
        double fraction;
    };
    std::deque<Sample> samples_;
};

/// A duration for people: "0.4 s", "12 s", "3 min 20 s", "2 h 5 min", "4 d 3 h".
std::string duration_text(double seconds);

}  // namespace lamella
