#pragma once

#include <limits>
#include <optional>

#include "lamella/core/vec.h"

namespace lamella::film {

/// How a wire that holds films moves: a rigid motion, and what is blown through it. [[wire]] of a scene.
struct Wire {
    Vec3 center;        ///< the point that it turns about, at the start [m]
    Vec3 velocity;      ///< of that point [m/s]
    Vec3 spin;          ///< angular velocity [rad/s]
    double start = 0.0; ///< it moves from here [s] ...
    double end = std::numeric_limits<double>::infinity();  ///< ... to here

    /// The shape of a ring, and what is blown through it.
    struct Ring {
        Vec3 axis;           ///< unit vector, at the start
        double radius = 0.0; ///< [m]
        double blow = 0.0;   ///< speed of the jet in the middle of an ideal vortex ring there, along the axis [m/s]
    };
    std::optional<Ring> ring = std::nullopt;  ///< nothing: a straight wire

    bool moves() const { return squared_norm(velocity) > 0.0 || squared_norm(spin) > 0.0; }
    /// Where the point of the wire that is at `x` at time `from` is at time `to` [m].
    Vec3 carried(const Vec3& x, double from, double to) const;
};

}  // namespace lamella::film
