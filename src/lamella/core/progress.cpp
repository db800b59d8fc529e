#include "lamella/core/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella {

void ProgressEstimate::update(double seconds, double fraction) {
    if (!samples_.empty() && fraction < samples_.back().fraction) samples_.clear();

    // Reports closer together than 1/300 of the time so far replace each other: the memory stays small.
    constexpr double kSamplesPerRun = 300.0;
    const bool crowded =
        samples_.size() >= 2 && seconds - samples_[samples_.size() - 2].seconds < seconds / kSamplesPerRun;
    if (crowded) samples_.pop_back();
    samples_.push_back({seconds, fraction});

    const double window = std::max(kShortestWindow, seconds / 3.0);
    while (samples_.size() > 2 && samples_[1].seconds <= seconds - window) samples_.pop_front();
}

std::optional<double> ProgressEstimate::rate() const {
    if (samples_.size() < 2) return std::nullopt;
    const double elapsed = samples_.back().seconds - samples_.front().seconds;
    const double progress = samples_.back().fraction - samples_.front().fraction;
    if (!(elapsed > 0.0) || !(progress > 0.0)) return std::nullopt;
    return progress / elapsed;
}

std::optional<double> ProgressEstimate::seconds_left() const {
    if (const auto r = rate()) return std::max(0.0, 1.0 - fraction()) / *r;
    return std::nullopt;
}

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds)) return "?";
    if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
    constexpr double kFarFuture = 1e15;  // keeps the conversion to an integer defined
    const auto whole = static_cast<long long>(std::min(seconds, kFarFuture) + 0.5);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    if (whole < 86400) return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
    return fmt::format("{} d {} h", whole / 86400, whole % 86400 / 3600);
}

}  // namespace lamella
