#pragma once

#include "lamella/core/fixed_sum.h"
#include "lamella/core/machine.h"
#include "lamella/solvers/bubble/chebyshev.h"
#include "lamella/solvers/bubble/clock.h"
#include "lamella/solvers/bubble/gas_sums.h"
#include "lamella/solvers/bubble/increment.h"
#include "lamella/solvers/bubble/liquid_law.h"
#include "lamella/spatial/cell_layout.h"

#include <cstdint>

// What a foam on a GPU consists of: its columns, and the block of numbers with which it steers itself.

namespace lamella::bubble::detail {

/// Bubbles that stand one after the other share a slice: entry n of the list of bubble i stands at
/// index[slice_start[i / kSlice] + n * kSlice + i % kSlice], so that the threads of a warp read side by side.
inline constexpr std::size_t kSlice = 32;

/// What a neighbor is asked for, 32 bytes at once. Radius 0: it has vanished.
template <int D>
struct alignas(32) StagedBall;
template <>
struct alignas(32) StagedBall<2> {
    double x[2];
    double radius;
    double inverse;
    LAMELLA_HOST_DEVICE double inverse_radius() const { return inverse; }
};
template <>
struct alignas(32) StagedBall<3> {
    double x[3];
    double radius;
    LAMELLA_HOST_DEVICE double inverse_radius() const { return radius > 0.0 ? 1.0 / radius : 0.0; }
};

template <int D>
LAMELLA_HOST_DEVICE StagedBall<D> staged_ball(const double (&x)[D], const StagedRadius<double>& r) {
    if constexpr (D == 2)
        return {{x[0], x[1]}, r.radius, r.inverse};
    else
        return {{x[0], x[1], x[2]}, r.radius};
}

/// A bubble that vanished, for the list of events.
template <int D>
struct VanishedBubble {
    std::int64_t id;
    std::int64_t step;
    double time;
    double position[D];
};

/// Everything the bodies of the loops read and write, but for the Control. Bubbles come first; copies of other devices'
/// bubbles follow in the columns that neighbors read. A part of each body: pointers that come
/// with a kernel cost nothing to follow.
template <int D>
struct DeviceView {
    // Columns of Foam<D>, by slot.
    double* position[D];
    double* velocity[D];
    double* start[D];
    double* marked[D];
    double* size;
    double* size_rate;
    double* path_length;
    std::int32_t* wraps[D];
    std::int64_t* id;
    // Where the bubbles stood, and their radii, when the lists were built.
    double* built_position[D];
    double* built_radius;
    // The stage being evaluated, its rates, and the increments of the last two stages.
    StagedBall<D>* stage;
    double* rate[D];
    double* film;
    double* weight;
    double* increment[2][D];
    double* size_increment[2];
    // Neighbors.
    const std::uint64_t* slice_start;
    const std::uint32_t* length;
    const std::uint32_t* index;
    const std::uint32_t* image;  ///< of each entry, a signed byte per axis; nullptr: take the nearest image

    const chebyshev::StageWeights* weights;  ///< of s stages: entries s (s + 1)/2 + 1 ...
    VanishedBubble<D>* vanished;

    Model model;
    LiquidLaw<D> liquid;
    Vec<D> inverse_lengths;
    GasSums no_gas;  ///< empty sums with their scales
    double min_radius;

    LAMELLA_HOST_DEVICE bool alive(std::size_t i) const { return size[i] > 0.0; }
};

/// What the next turn of the loops does.
enum class Phase : std::int32_t {
    kFirst,         ///< evaluate the current state
    kKeep,          ///< keep its rates
    kMeanRadius,    ///< for a tolerance that is relative to it
    kStage,         ///< the next stage of the step
    kError,         ///< estimate the step's error
    kErrorSquares,  ///< add up its squares
    kAccept,        ///< the last stage becomes the state
    kRemove,        ///< take out what has vanished
    kShare,         ///< give its gas to the others
};

/// Why the loops wait for the host.
enum class Waiting : std::int32_t {
    kNot,
    kLimit,      ///< the time limit is reached
    kEnd,        ///< few bubbles are left, or one spans the box
    kSteps,      ///< as many steps as were asked for
    kLists,      ///< new neighbor lists are needed
    kUnderflow,  ///< no step is small enough
    kNothing,    ///< all bubbles would vanish in one step
};

/// The numbers that steer the run; decisions are taken on them by one thread of the device.
struct Control {
    // Set by the host for each visit.
    double limit = 0.0;  ///< solver time not to pass
    std::int64_t steps_left = 0;
    double end_count = 1.0;
    // From the options.
    double time_rate = 1.0;
    double max_step = 0.0;
    double tolerance = 0.0;
    double shortest_edge = 0.0;
    double box_volume = 0.0;
    std::int32_t relative_error = 0;
    std::int32_t rms_error = 0;
    std::int32_t printed_removal = 0;
    double most_terms = kMostTerms;  ///< that a sum over all devices may have
    // The foam.
    std::uint64_t slots = 0;     ///< bubbles of this device, vanished ones included
    std::uint64_t interior = 0;  ///< the first so many have no copies of another device's in their lists
    std::uint64_t live = 0;      ///< bubbles of all devices
    double max_size = 0.0;
    double reach = 0.0;        ///< how far |dx| + dR may go before lists are outgrown
    double least_reach = 0.0;  ///< wanted of the next lists
    double expansion = 0.0;    ///< largest |dx| + dR since the lists were built
    // The run.
    Clock clock;
    double next_step = 0.0;
    double stiffness = 0.0;
    std::int32_t rates_current = 0;
    // The step.
    Waiting waiting = Waiting::kNot;
    Phase phase = Phase::kFirst;
    std::int32_t first_attempt = 1;  ///< the lists that are waited for come before a new step, not within one
    Landing landing{};
    Step step;
    double error = 0.0;  ///< of the last attempt
    double step_tolerance = 0.0;
    double first_stiffness = 0.0;
    double wanted = 0.0;
    double h = 0.0;
    std::int32_t stages = 0;
    std::int32_t stage = 0;
    double stage_reach = 0.0;
    double expected_reach = 0.0;
    GasExchange gas;
    double sum_scale = 0.0;  ///< bound of the sum that a phase adds up
    // Removal.
    std::uint64_t vanishing = 0;
    double excess = 0.0;
    double lost_scale = 0.0;
    double lost = 0.0;
    double survivors = 0.0;
    double removal_factor = 1.0;
    std::uint32_t events = 0;

    /// The scale of exact_sum: what its terms may add up to, from the largest of them.
    LAMELLA_HOST_DEVICE double sum_bound(double largest_term) const { return largest_term * most_terms; }
    LAMELLA_HOST_DEVICE bool running() const { return waiting == Waiting::kNot; }
    LAMELLA_HOST_DEVICE bool last_stage() const { return stage == stages; }
    LAMELLA_HOST_DEVICE bool evaluates() const { return phase == Phase::kFirst || phase == Phase::kStage; }
    /// The stiffness is wanted of the state that a step begins or ends with.
    LAMELLA_HOST_DEVICE bool bounds_stiffness() const {
        return phase == Phase::kFirst || (phase == Phase::kStage && last_stage());
    }
};

/// A FixedSum whose integers are words of a Reduction.
LAMELLA_HOST_DEVICE inline void add_term(const FixedSum& none, double term, std::int64_t* words) {
    FixedSum one = none;
    one.add(term);
    words[0] += one.high();
    words[1] += one.low();
}
LAMELLA_HOST_DEVICE inline FixedSum sum_of(const FixedSum& none, const std::int64_t* words) {
    FixedSum sum = none;
    sum.high() = words[0];
    sum.low() = words[1];
    return sum;
}
}  // namespace lamella::bubble::detail
