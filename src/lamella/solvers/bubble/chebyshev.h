#pragma once

#include "lamella/core/simd.h"
#include "lamella/solvers/bubble/shape.h"

#include <cmath>
#include <vector>

// Runge-Kutta-Chebyshev of order 2 [Sommeijer98]: its weights, and how it chooses stages and steps.

namespace lamella::bubble::chebyshev {

inline constexpr int kMostStages = 250;

/// d_j = mu d_(j-1) + nu d_(j-2) + h (rate f_(j-1) + first_rate f_0)
struct StageWeights {
    double mu, nu, rate, first_rate;
};

/// The weights of an s-stage step, entries 1 to s [Sommeijer98, section 2].
std::vector<StageWeights> stage_weights(int s);

/// d_j of one quantity of one bubble, or of eight. The first stage knows f_0 only.
/// @param w  weights with `rate` and `first_rate` times h
template <class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real
stage_increment(const StageWeights& w, const Real& first, const Real& last, const Real& before, const Real& rate) {
    Real d = w.first_rate * first;
    d += w.mu * last + w.nu * before + w.rate * rate;
    return d;
}

/// 0.8 (y_n - y_(n+1)) + 0.4 h (f_n + f_(n+1)) of one quantity   [Sommeijer98, section 3]
LAMELLA_HOST_DEVICE inline double step_error(double h, double d, double first, double last) {
    return -0.8 * d + 0.4 * h * (first + last);
}

/// Stages that make a step of h stable, and h itself, cut where even the most stages would not do.
/// @param stiffness  bound of the relaxation rates; 5 % are added for contacts that close during the step
struct Stages {
    int count;
    double h;
};
LAMELLA_HOST_DEVICE inline Stages stages_for(double h, double stiffness) {
    int count = 1 + static_cast<int>(std::sqrt(1.0 + 1.54 * h * 1.05 * stiffness));
    count = count < 2 ? 2 : count;
    if (count <= kMostStages) return {count, h};
    return {kMostStages, (kMostStages * kMostStages - 1) / (1.54 * 1.05 * stiffness)};
}

/// The step that follows one of h with this error. An error that is infinite (or NaN) cuts it to a tenth.
LAMELLA_HOST_DEVICE inline double next_step(double h, double error, double tolerance) {
    const double ratio = tolerance / larger(error, 1e-30);
    const double factor = ratio > 1e-9 ? 0.8 * cube_root(smaller(ratio, 1e9)) : 0.0;
    return smaller(larger(factor, 0.1), 5.0) * h;
}

}  // namespace lamella::bubble::chebyshev
