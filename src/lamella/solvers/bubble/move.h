#pragma once

#include <cmath>
#include <limits>

#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/core/simd.h"
#include "lamella/solvers/bubble/system.h"

// What every integrator does with an increment (dx, dq) of the state.

namespace lamella::bubble {

template <int D>
struct Increment {
    Columns<D> position;
    Column size;

    void resize(std::size_t length) {
        for (auto& column : position) column.resize(length);
        size.resize(length);
    }
    void assign_zero(std::size_t length) {
        for (auto& column : position) column.assign(length, 0.0);
        size.assign(length, 0.0);
    }
};

/// x moved back into [0, L) by at most one box length; `wraps` counts the crossing.
inline double wrapped(double x, double length, std::int32_t& wraps) {
    if (x < 0.0) {
        x += length;
        --wraps;
    }
    if (x >= length) {
        x -= length;
        ++wraps;
    }
    return x;
}

/// Half the mean spacing of the bubbles. A bubble that jumps further in one step has left its neighborhood, and no
/// error estimate would notice where it lands.
template <int D>
double farthest_move(const System<D>& system) {
    return 0.5 * std::pow(system.foam.box.volume() / static_cast<double>(system.foam.live), 1.0 / D);
}

/// stage = current state + increment, positions wrapped into the box.
template <int D>
void stage_moved(System<D>& system, const Increment<D>& increment);

/// The current state becomes `stage` (as stage_moved left it); path lengths and wrap counts follow.
template <int D>
void accept_moved(System<D>& system, const Increment<D>& increment);

/// Error norm over the bubbles of an estimate in position and size, as a length: largest (or root mean square) of
/// |ex_k| and |eq|/(d R^(d-1)), R at least the radius at which bubbles vanish.
/// @param estimate  estimate(i, ex, eq) fills the estimates of slot i
template <int D, class Estimate>
double error_norm(const System<D>& system, ErrorNorm norm, Estimate&& estimate) {
    const double min_radius = Shape<D>::radius(system.model.min_size);
    const auto of_bubble = [&](std::size_t i) {
        double ex[D];
        double eq = 0.0;
        estimate(i, ex, eq);
        const double radius = system.stage.radius[i] > min_radius ? system.stage.radius[i] : min_radius;
        double worst = std::abs(eq) / (D == 2 ? 2.0 * radius : 3.0 * radius * radius);
        for (std::size_t k = 0; k < D; ++k) worst = larger(worst, std::abs(ex[k]));
        // A NaN must not lose the comparison: it makes the step fail.
        return worst == worst ? worst : std::numeric_limits<double>::infinity();
    };
    const std::size_t count = system.foam.slots;
    if (norm == ErrorNorm::kMax) return system.domain().largest(parallel_max(count, 0.0, of_bubble));
    const double squares = exact_sum(count, [&](std::size_t i) { return of_bubble(i) * of_bubble(i); });
    return std::sqrt(squares / static_cast<double>(system.foam.live));
}

}  // namespace lamella::bubble
