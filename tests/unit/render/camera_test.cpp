#include "lamella/render/camera.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include "shown_frames.h"

namespace lamella::render {
namespace {

TEST(FrameBounds, EncloseWhatIsSeen) {
    const Bounds sphere = frame_bounds(sphere_film(2));
    EXPECT_NEAR(sphere.radius, 1.0, 1e-12);
    sim::Frame frame = one_ball();
    frame.points.position[0] = {{10.0, 0.0, 0.0}};
    const Bounds ball = frame_bounds(frame);
    EXPECT_NEAR(ball.center[0], 10.0, 1e-12);
    const Bounds both = joined(sphere, ball);
    EXPECT_NEAR(both.radius, 6.0, 1e-12);
    EXPECT_NEAR(both.center[0], 5.0, 1e-12);
    EXPECT_NEAR(joined(both, ball).radius, 6.0, 1e-12);
    EXPECT_THROW(frame_bounds({}), InputError);
}

TEST(Camera, SeesTheWholeBallFromWhereItIsTold) {
    for (const double azimuth : {-62.0, 0.0, 135.0})
        for (const double elevation : {-90.0, 16.0, 90.0}) {
            const Bounds ball{{{1.0, 2.0, 3.0}}, 2.0};
            View view;
            view.azimuth_deg = azimuth;
            view.elevation_deg = elevation;
            const Camera camera(view, ball, 300, 200);
            const Vec3 ahead = ball.center - camera.position();
            EXPECT_NEAR(dot(camera.direction(150.0, 100.0), ahead), norm(ahead), 1e-9);
            // The upper edge of the picture passes above the ball, by no more than a tenth of its radius.
            const Vec3 edge = camera.direction(150.0, 0.0);
            const double distance = norm(ahead - dot(ahead, edge) * edge);
            EXPECT_GT(distance, 2.0);
            EXPECT_LT(distance, 2.2);
            if (elevation == 16.0) {
                EXPECT_GT(edge[2], camera.direction(150.0, 200.0)[2]);  // z points up
            }
        }
}

}  // namespace
}  // namespace lamella::render
