#pragma once

#include "lamella/core/host_device.h"

#include <cstdint>

namespace lamella::bubble {

/// What one accepted step did.
struct Step {
    double time = 0.0;   ///< mechanical time by which the state advanced
    double clock = 0.0;  ///< time by which the clock advances: the same, unless compat.clock asks for the published bug
    double error = 0.0;  ///< its error estimate [length]
    std::int64_t evaluations = 0;  ///< of the attempts that counted (an attempt whose lists were outgrown is repeated)
    std::int64_t rejections = 0;
};

/// How a step has to end so that the run meets `limit`.
struct Landing {
    double longest;  ///< mechanical time that the step may take
    bool lands;      ///< the limit is within reach of the wanted step
};

/// Time and counters of a run.
struct Clock {
    double time = 0.0;  ///< solver time
    double mechanical_time = 0.0;
    std::int64_t steps = 0;
    std::int64_t evaluations = 0;
    std::int64_t rejections = 0;

    /// Two equal steps rather than a long one and a sliver.
    /// @param limit   solver time not to pass
    /// @param rate    solver time per mechanical time
    /// @param wanted  the next step if there were no limit
    LAMELLA_HOST_DEVICE Landing landing(double limit, double rate, double wanted) const {
        const double longest = (limit - time) / rate;
        const bool lands = longest <= wanted;
        return {!lands && longest < 2.0 * wanted ? longest * 0.5 : longest, lands};
    }

    /// Counts a step that was taken; a step that spends all that it was given is at the limit exactly.
    LAMELLA_HOST_DEVICE void tick(const Step& step, const Landing& landing, double limit, double rate) {
        mechanical_time += step.clock;
        const bool full = landing.lands && step.time == landing.longest;
        time = full && step.clock == step.time ? limit : time + step.clock * rate;
        ++steps;
        evaluations += step.evaluations;
        rejections += step.rejections;
    }
};

}  // namespace lamella::bubble
