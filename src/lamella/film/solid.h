#pragma once

#include "lamella/core/vec.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace lamella::film {

/// A ball, or a stick with round ends, that a film runs around and that takes the film with it. It moves and turns as
/// it is told, once or in steps like a leg, or freely. [[solid]] of a scene.
struct Solid {
    Vec3 center;                                           ///< at time 0 [m]
    double radius = 0.0;                                   ///< [m]
    Vec3 velocity{};                                       ///< as it is told; of a free one at the start [m/s]
    Vec3 spin{};                                           ///< angular velocity, likewise [rad/s]
    double start = 0.0;                                    ///< it moves from here [s] ...
    double end = std::numeric_limits<double>::infinity();  ///< ... to here
    double period = 0.0;  ///< > 0: it does so again each period, and between is out of the film, on its way back [s]
    Vec3 stride{};        ///< how much farther each period begins [m]
    bool free = false;    ///< what the film does to it moves it
    double mass = 0.0;    ///< of a free one, beyond that of the film that it covers [kg]
    Vec3 arm{};           ///< of a stick: from its middle to the center of a round end [m]; 0: a ball
    bool wet = true;      ///< films slide on it; false: they burst where it touches them

    double since_period(double time) const { return period > 0.0 ? time - period * std::floor(time / period) : time; }
    bool moves(double time) const { return since_period(time) >= start && since_period(time) < end; }
    bool in_film(double time) const { return period == 0.0 || moves(time); }
    Vec3 center_at(double time) const {
        const Vec3 begin = period > 0.0 ? center + std::floor(time / period) * stride : center;
        return begin + (std::clamp(since_period(time), start, end) - start) * velocity;
    }
};

/// The point nearest to `x` on the straight line from center - arm to center + arm [m].
inline Vec3 nearest_on_axis(const Vec3& center, const Vec3& arm, const Vec3& x) {
    const double square = squared_norm(arm);
    return square > 0.0 ? center + std::clamp(dot(x - center, arm) / square, -1.0, 1.0) * arm : center;
}

/// A solid at one moment.
struct Body {
    double radius = 0.0;  ///< [m]
    bool in_film = true;
    bool free = false;
    double mass = 0.0;    ///< beyond that of the film that it covers [kg]
    Vec3 center;          ///< [m]
    Vec3 velocity, spin;  ///< [m/s], [rad/s]
    /// What the film did to it in the last step, the film that it covers counted with the solid; the torque about its
    /// center [N], [N m].
    Vec3 force, torque;
    Vec3 arm{};  ///< of a stick
    bool wet = true;

    Vec3 velocity_at(const Vec3& x) const { return velocity + cross(spin, x - center); }
    /// How far `x` is from its surface; negative inside [m].
    double distance(const Vec3& x) const { return norm(x - nearest_on_axis(center, arm, x)) - radius; }
};

std::vector<Body> bodies_at_start(std::span<const Solid> solids);
/// Puts those that move as they are told where they are at `time`; the others `ahead` in time by their velocity [s].
void move_bodies(std::span<const Solid> solids, double time, double ahead, std::span<Body> bodies);

/// The largest speed of any solid's surface that is told [m/s].
double fastest(std::span<const Solid> solids);

}  // namespace lamella::film
