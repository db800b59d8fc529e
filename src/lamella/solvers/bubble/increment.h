#pragma once

#include "lamella/core/simd.h"
#include "lamella/solvers/bubble/model.h"
#include "lamella/solvers/bubble/shape.h"

#include <cmath>
#include <cstdint>
#include <limits>

// How one bubble (or eight) takes an increment (dx, dq) of a step or of a stage.

namespace lamella::bubble {

/// x moved back into [0, L) by at most one box length; `wraps` counts the crossing.
LAMELLA_HOST_DEVICE inline double wrapped(double x, double length, std::int32_t& wraps) {
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

/// R of a size q > 0.
template <int D>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE double root_of_size(double q) {
    return Shape<D>::radius(q);
}
#ifndef __CUDACC__
template <int D>
LAMELLA_ALWAYS_INLINE Simd root_of_size(const Simd& q) {
    if constexpr (D == 2) return square_root(q);
    double lanes[kLanes];
    store_lanes(q, lanes);
    for (double& lane : lanes) lane = cube_root(lane);
    return load_lanes(lanes);
}
#endif

/// Radius and inverse radius of a size inside a step; 0 where the bubble had vanished before it.
template <class Real>
struct StagedRadius {
    Real radius;
    Real inverse;
};
/// @param size   q at the start of the step; 0: vanished
/// @param moved  q + dq; a bubble that dies within the step passes zero, then model.floor_size counts
template <int D, class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE StagedRadius<Real> staged_radius(const Model& model,
                                                                           const Real& size,
                                                                           const Real& moved) {
    const Real radius = root_of_size<D>(larger(moved, Real(model.floor_size)));
    const auto alive = size > Real(0.0);
    return {select(alive, radius, Real(0.0)), select(alive, Real(1.0) / radius, Real(0.0))};
}

/// A bound of the growth in radius by dq:  R' - R <= (q' - q)/R'^(d-1) for growing bubbles. @param inverse  1/R'
template <int D, class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real growth_bound(const Real& dq, const Real& inverse) {
    Real growth = larger(dq, Real(0.0)) * inverse;
    if constexpr (D == 3) growth *= inverse;
    return growth;
}

/// Error of one bubble as a length: largest of |ex_k| and |eq|/(d R^(d-1)), R at least the radius at which bubbles
/// vanish. A NaN must not lose the comparison: it makes the step fail.
template <int D>
LAMELLA_HOST_DEVICE double bubble_error(const double (&ex)[D], double eq, double radius, double min_radius) {
    const double r = radius > min_radius ? radius : min_radius;
    double worst = std::fabs(eq) / (D == 2 ? 2.0 * r : 3.0 * r * r);
    for (int k = 0; k < D; ++k) worst = larger(worst, std::fabs(ex[k]));
    return worst == worst ? worst : std::numeric_limits<double>::infinity();
}

/// Factor of the survivors' q when vanished bubbles leave them a share a of what they have: 1 + a. @param as_printed
/// R + R a^(1/d) instead, as in the thesis, which creates gas (compat.removal)
template <int D>
LAMELLA_HOST_DEVICE double growth_by_removal(double share, bool as_printed) {
    return as_printed && share > 0.0 ? Shape<D>::size(1.0 + Shape<D>::radius(share)) : 1.0 + share;
}

/// Half the mean spacing of the bubbles. A bubble that jumps further in one step has left its neighborhood, and no
/// error estimate would notice where it lands.
template <int D>
LAMELLA_HOST_DEVICE double half_spacing(double volume, double live) {
    return 0.5 * Shape<D>::radius(volume / live);
}

}  // namespace lamella::bubble
