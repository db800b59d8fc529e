#pragma once

#include "lamella/dist/communicator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::dist {

/// Weights with which all processes would need the same time: each gets as much as it is fast, within bounds that keep
/// memory even. The mean is about kEvenWeight.
/// @param cost  of one item, per process; 0: not known
std::vector<std::int64_t> weights_for(std::span<const std::int64_t> cost);
inline constexpr std::int64_t kEvenWeight = 1024;

/// What part of all items each process should have. Cores differ in speed, most of all where others work beside, and
/// the slowest process sets the pace; so the processes measure their work, and who is slower gets less. No result may
/// depend on that: times are never the same twice.
class Balance {
public:
    explicit Balance(Communicator& processes);

    /// While it lives, this process does its part of what goes with the number of its items.
    class Working {
    public:
        explicit Working(Balance& balance) : balance_(balance) { balance_.start(); }
        ~Working() { balance_.stop(); }
        Working(const Working&) = delete;
        Working& operator=(const Working&) = delete;

    private:
        Balance& balance_;
    };

    /// Collective. Looks at the work done with `items` items since the weights were last looked at; once that is long
    /// enough to tell, takes new weights if the slowest process holds up the others.
    /// @returns  whether there are new weights; the same on all processes
    bool update(std::size_t items);

    /// One per process, the same on all processes.
    std::span<const std::int64_t> weights() const { return weights_; }
    /// This process's part of all items; the parts add up to 1.
    double share() const;

private:
    void start();
    void stop();

    Communicator* processes_;
    std::vector<std::int64_t> weights_;
    double seconds_ = 0.0;  ///< of work since the last look, but for what is under way
    double started_ = 0.0;
    bool working_ = false;
};

}  // namespace lamella::dist
