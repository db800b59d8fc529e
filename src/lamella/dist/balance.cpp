#include "lamella/dist/balance.h"

#include "lamella/dist/gather.h"
#include "lamella/dist/sum.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::dist {
namespace {

constexpr double kLongEnough = 4.0;  // [s]: many times what it costs to cut the box anew
constexpr double kHeldUp = 1.05;     // longest over mean time that is worth it
constexpr double kMostUneven = 0.25;

/// Longest over mean time for so many items each.
double held_up(std::span<const std::int64_t> cost, std::span<const std::int64_t> weights) {
    double longest = 0.0;
    double sum = 0.0;
    for (std::size_t r = 0; r < cost.size(); ++r) {
        const double time = static_cast<double>(cost[r]) * static_cast<double>(weights[r]);
        longest = std::max(longest, time);
        sum += time;
    }
    return sum > 0.0 ? longest * static_cast<double>(cost.size()) / sum : 1.0;
}

}  // namespace

std::vector<std::int64_t> weights_for(std::span<const std::int64_t> cost) {
    std::vector<std::int64_t> weights(cost.size(), kEvenWeight);
    if (std::any_of(cost.begin(), cost.end(), [](std::int64_t c) { return c <= 0; })) return weights;
    double mean_speed = 0.0;
    for (const std::int64_t c : cost) mean_speed += 1.0 / static_cast<double>(c);
    mean_speed /= static_cast<double>(cost.size());
    for (std::size_t r = 0; r < cost.size(); ++r) {
        const double speed = 1.0 / (static_cast<double>(cost[r]) * mean_speed);
        const double part = std::clamp(speed, 1.0 - kMostUneven, 1.0 + kMostUneven);
        weights[r] = std::llround(part * static_cast<double>(kEvenWeight));
    }
    return weights;
}

Balance::Balance(Communicator& processes)
    : processes_(&processes), weights_(static_cast<std::size_t>(processes.size()), kEvenWeight) {}

void Balance::start() {
    started_ = processes_->work_clock();
    working_ = true;
}

void Balance::stop() {
    seconds_ += processes_->work_clock() - started_;
    working_ = false;
}

double Balance::share() const {
    const auto all = std::accumulate(weights_.begin(), weights_.end(), std::int64_t{0});
    return static_cast<double>(weights_[static_cast<std::size_t>(processes_->rank())]) / static_cast<double>(all);
}

bool Balance::update(std::size_t items) {
    if (!processes_->several()) return false;
    if (working_) {
        stop();
        start();
    }
    if (largest(*processes_, seconds_) < kLongEnough) return false;
    const double picoseconds = 1e12 * seconds_ / static_cast<double>(std::max<std::size_t>(items, 1));
    seconds_ = 0.0;
    const std::vector<std::int64_t> cost =
        detail::counts_of_all(*processes_, items == 0 ? 0 : static_cast<std::size_t>(std::min(picoseconds, 1e15)));
    if (held_up(cost, weights_) < kHeldUp) return false;
    std::vector<std::int64_t> weights = weights_for(cost);
    // Who is at the bounds already may stay the slowest.
    if (held_up(cost, weights) * kHeldUp > held_up(cost, weights_)) return false;
    weights_ = std::move(weights);
    return true;
}

}  // namespace lamella::dist
