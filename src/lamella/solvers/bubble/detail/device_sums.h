#pragma once

#include "lamella/dist/communicator.h"
#include "lamella/solvers/bubble/detail/device_view.h"

#include <algorithm>
#include <array>
#include <span>

// One turn of the loops that advance a foam on a GPU by steps of rkc2 (see rkc2.cpp, whose bits this repeats): update
// each bubble (device_update.h), gather over its contacts (device_gather.h), decide (device_decide.h). The phase says
// what a turn does; decisions are taken by one thread on what the loops have added up, and the host is asked only for
// new neighbor lists. Where several devices share the foam, the host of each adds up with the others and decides.

namespace lamella::bubble::detail {

using UpdateSums = Reduction<3, 5>;
using GatherSums = Reduction<2, 6>;

/// What the loops of a turn have added up.
struct TurnSums {
    UpdateSums update;
    GatherSums gather;
};

struct KeepTurnSums {
    TurnSums* result;
    LAMELLA_HOST_DEVICE void operator()(const UpdateSums& update, const GatherSums& gather) const {
        *result = {update, gather};
    }
};

using RadiusSum = Reduction<1, 2>;
struct KeepRadiusSum {
    RadiusSum* result;
    LAMELLA_HOST_DEVICE void operator()(const RadiusSum& sum, const RadiusSum&) const { *result = sum; }
};

/// A FixedSum in two words, such that those of very many devices can be added.
inline void carry(std::int64_t* words) {
    FixedSum sum = sum_of(FixedSum(), words);
    sum.carry();
    words[0] = sum.high();
    words[1] = sum.low();
}

/// Adds up a turn over all devices.
/// @param gathered  it has evaluated a stage; else only the update counts
inline void add_up_turn(TurnSums& turn, bool gathered, dist::Communicator& processes) {
    std::array<std::int64_t, std::size(decltype(turn.update.sum){}) + std::size(decltype(turn.gather.sum){})> sums;
    std::array<double, std::size(decltype(turn.update.maximum){}) + std::size(decltype(turn.gather.maximum){})> maxima;
    UpdateSums& update = turn.update;
    GatherSums& gather = turn.gather;
    // The first word of the update is a plain count.
    for (const std::size_t n : {1, 3}) carry(&update.sum[n]);
    for (const std::size_t n : {0, 2, 4}) carry(&gather.sum[n]);
    std::copy(std::begin(gather.sum), std::end(gather.sum),
              std::copy(std::begin(update.sum), std::end(update.sum), sums.begin()));
    std::copy(std::begin(gather.maximum), std::end(gather.maximum),
              std::copy(std::begin(update.maximum), std::end(update.maximum), maxima.begin()));
    processes.reduce(std::span(sums).first(gathered ? sums.size() : std::size(update.sum)),
                     std::span(maxima).first(gathered ? maxima.size() : std::size(update.maximum)));
    std::copy_n(sums.begin(), std::size(update.sum), update.sum);
    std::copy_n(maxima.begin(), std::size(update.maximum), update.maximum);
    std::copy_n(sums.begin() + std::size(update.sum), std::size(gather.sum), gather.sum);
    std::copy_n(maxima.begin() + std::size(update.maximum), std::size(gather.maximum), gather.maximum);
}

}  // namespace lamella::bubble::detail
