#pragma once

#include <cmath>

#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/bubble/increment.h"
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

template <int D>
double farthest_move(const System<D>& system) {
    return half_spacing<D>(system.foam.box.volume(), static_cast<double>(system.foam.live));
}

/// stage = current state + increment. Positions are not wrapped into the box: images in lists stay right.
template <int D>
void stage_moved(System<D>& system, const Increment<D>& increment);

/// The current state moves by the increment and is wrapped into the box; path lengths and wrap counts follow. Before lists
/// are used again, System::follow_images.
template <int D>
void accept_moved(System<D>& system, const Increment<D>& increment);

/// Error norm over the bubbles of an estimate in position and size: largest (or root mean square) bubble_error.
/// @param estimate  estimate(i, ex, eq) fills the estimates of slot i
template <int D, class Estimate>
double error_norm(const System<D>& system, ErrorNorm norm, Estimate&& estimate) {
    const double min_radius = Shape<D>::radius(system.model.min_size);
    const auto of_bubble = [&](std::size_t i) {
        double ex[D];
        double eq = 0.0;
        estimate(i, ex, eq);
        return bubble_error<D>(ex, eq, system.stage.radius[i], min_radius);
    };
    const std::size_t count = system.foam.slots;
    if (norm == ErrorNorm::kMax) return system.domain().largest(parallel_max(count, 0.0, of_bubble));
    const double squares = system.domain().exact_sum(count, [&](std::size_t i) { return of_bubble(i) * of_bubble(i); });
    return std::sqrt(squares / static_cast<double>(system.foam.live));
}

}  // namespace lamella::bubble
