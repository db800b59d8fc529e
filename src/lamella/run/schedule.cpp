#include "lamella/run/schedule.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::run {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSame = 1e-9;  ///< relative difference up to which two times are one

bool is_same(double a, double b) { return !is_after(a, b) && !is_after(b, a); }

/// The smallest sequence(k), k a whole number from `guess` - 1 on, that lies after `time`. The guess may be off by
/// one, because it comes from the inverse of the sequence.
template <class Sequence>
double first_after(double time, double guess, Sequence&& sequence) {
    double k = std::max(0.0, std::floor(guess) - 1.0);
    while (!is_after(sequence(k), time)) {
        const double following = k + 1.0;
        if (following == k) return kInfinity;  // beyond 2^53 outputs the numbers end: none is due any more
        k = following;
    }
    return sequence(k);
}

double next_regular(double time, double rate) {
    if (!(rate > 0.0)) return kInfinity;
    return first_after(time, time * (1.0 + kSame) * rate, [&](double k) { return k / rate; });
}

double next_logarithmic(double time, double start, double per_decade) {
    if (!(per_decade > 0.0)) return kInfinity;
    const double guess = time > 0.0 ? per_decade * std::log10(time * (1.0 + kSame) / start) : 0.0;
    return first_after(time, guess, [&](double k) { return start * std::pow(10.0, k / per_decade); });
}

}  // namespace

bool is_after(double a, double b) { return a > b + kSame * std::abs(b); }

Schedule::Schedule(const scene::TimeOptions& options, std::optional<double> until)
    : options_(options), end_(options.end > 0.0 ? options.end : kInfinity) {
    if (until) {
        if (!(*until > 0.0 && std::isfinite(*until)))
            throw InputError(fmt::format("the time to run until must be a positive number, not {}", *until));
        end_ = *until;
    }
    constexpr double kMostOutputs = 1e9;
    const double fastest = std::max(options.frame_rate, options.series_rate);
    if (std::isfinite(end_) && fastest * end_ > kMostOutputs)
        throw InputError(fmt::format("a rate of {:g} per unit of time until time {:g} asks for more than {:g} outputs",
                                     fastest, end_, kMostOutputs));
}

OutputTime Schedule::next(double time, double slow_motion) const {
    const double frame = next_regular(time, slow_motion * options_.frame_rate);
    const double row = std::min(next_regular(time, options_.series_rate),
                                next_logarithmic(time, options_.log_start, options_.series_per_decade));
    const double first = std::min({frame, row, end_});
    // At the end a frame is always due. The end's own value stands even where a frame's differs by rounding.
    if (!is_after(end_, first)) return {end_, true};
    if (is_same(frame, first)) return {frame, true};
    return {first, false};
}

}  // namespace lamella::run
