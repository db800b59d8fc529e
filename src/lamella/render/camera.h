#pragma once

#include "lamella/core/vec.h"
#include "lamella/sim/frame.h"

namespace lamella::render {

/// From where a frame is looked at. z points up.
struct View {
    double azimuth_deg = -62.0;       ///< of the camera around the z axis; 0: on the +x side
    double elevation_deg = 16.0;      ///< above the horizon; 90: from straight above, +y up in the picture
    double zoom = 1.0;                ///< 1: everything just fits
    double field_of_view_deg = 26.0;  ///< of the picture's shorter side
    double shift = 0.0;               ///< of the middle to the left, relative to the picture's width: room for a legend
};

/// The ball around everything that is seen.
struct Bounds {
    Vec3 center;
    double radius = 1.0;
};

/// @throws InputError  the frame shows nothing
Bounds frame_bounds(const sim::Frame& frame);
/// The smallest ball around both.
Bounds joined(const Bounds& a, const Bounds& b);

/// From where a frame is best seen: what is flat and two-dimensional from straight above; a film in a plane, which
/// would be seen from its edge, so that one looks on it; all else a little from the side and above.
/// @param room  width and height that are free of the picture, relative to its shorter side
View usual_view(const sim::Frame& frame, const Vec2& room = {{4.0 / 3.0, 1.0}});

/// Rays through the points of a picture.
class Camera {
public:
    Camera(const View& view, const Bounds& bounds, std::size_t width, std::size_t height);

    const Vec3& position() const { return position_; }
    /// Unit direction through a point of the picture [pixels], (0, 0) its upper left corner.
    Vec3 direction(double x, double y) const;

private:
    Vec3 position_, corner_, across_, down_;  // corner_ + x across_ + y down_ is the direction
};

}  // namespace lamella::render
