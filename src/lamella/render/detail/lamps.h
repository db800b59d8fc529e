#pragma once

#include "lamella/core/vec.h"
#include "lamella/optics/color.h"

namespace lamella::render::detail {

/// How a rectangular lamp is described.
struct LampPlan {
    double azimuth_deg, elevation_deg;     ///< of its middle
    double half_width, half_height;        ///< tangents of half the angles under which it is seen
    double roundness;                      ///< radius of its corners, in the same measure
    double softness;                       ///< width of its edge, in the same measure
    optics::Rgb light;                     ///< in its middle
    int panes_across = 1, panes_down = 1;  ///< a window has several, with bars between them
};

/// A lamp infinitely far away, brightest in its middle.
class Lamp {
public:
    explicit Lamp(const LampPlan& plan);

    /// Its light from a direction (unit).
    optics::Rgb light(const Vec3& direction) const;

private:
    double behind_bars(double x, double y) const;

    LampPlan plan_;
    Vec3 middle_, right_, up_;
    double reach_ = 0.0;  ///< cosine of the angle beyond which nothing of it is seen
};

/// 0 below `low`, 1 above `high`, smooth between.
double smooth_step(double low, double high, double x);

}  // namespace lamella::render::detail
