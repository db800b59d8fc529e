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

/// The film with x, y, z for its y, z, x or z, x, y.
sim::Frame turned(sim::Frame frame, std::size_t by) {
    for (Vec3& p : frame.surface.position) p = {{p[(3 - by) % 3], p[(4 - by) % 3], p[(5 - by) % 3]}};
    return frame;
}

TEST(UsualView, LooksOnFilmsInAPlane) {
    const auto direction = [](const View& view) {
        return (Camera(view, {}, 10, 10).position()) / norm(Camera(view, {}, 10, 10).position());
    };
    for (const std::size_t by : {0U, 1U, 2U}) {
        const sim::Frame film = turned(flat_film(3), by);
        const Vec3 normal{{by == 1 ? 1.0 : 0.0, by == 2 ? 1.0 : 0.0, by == 0 ? 1.0 : 0.0}};
        EXPECT_GT(std::abs(dot(direction(usual_view(film)), normal)), 0.7) << by;
    }
    EXPECT_EQ(usual_view(flat_film(3)).azimuth_deg, -90.0);             // y goes up
    EXPECT_LT(direction(usual_view(turned(flat_film(3), 1)))[2], 0.0);  // upright: its mirror image is that of lamps
    EXPECT_EQ(usual_view(sphere_film(2)).elevation_deg, View{}.elevation_deg);
    sim::Frame foam = one_ball();
    foam.box = sim::Box{.dimension = 2, .origin = {}, .lengths = {{1.0, 1.0, 0.0}}, .periodic = {}};
    EXPECT_EQ(usual_view(foam).elevation_deg, 90.0);
    EXPECT_EQ(usual_view({}).elevation_deg, View{}.elevation_deg);
}

/// How far from the middle of a picture of 400 x 300 pixels the film comes, its edges being 1: across and up.
Vec2 filled_part(const sim::Frame& film, const View& view) {
    const Camera camera(view, frame_bounds(film), 400, 300);
    Vec2 farthest{};
    for (const Vec3& p : film.surface.position) {
        const Vec3 ray = p - camera.position(), ahead = -1.0 * camera.position();
        const Vec3 right = camera.direction(400.0, 150.0) - camera.direction(0.0, 150.0),
                   up = camera.direction(200.0, 0.0) - camera.direction(200.0, 300.0);
        const auto share = [&](const Vec3& axis, const Vec3& edge) {
            const Vec3 n = axis / norm(axis);
            return std::abs(dot(ray, n) / dot(ray, ahead)) / std::abs(dot(edge, n) / dot(edge, ahead));
        };
        farthest = {{std::max(farthest[0], share(right, camera.direction(400.0, 150.0))),
                     std::max(farthest[1], share(up, camera.direction(200.0, 0.0)))}};
    }
    return farthest;
}

TEST(UsualView, FillsWhatIsFreeOfThePicture) {
    for (const std::size_t by : {0U, 1U, 2U}) {
        const sim::Frame film = turned(flat_film(3), by);
        const Vec2 all = filled_part(film, usual_view(film));
        EXPECT_NEAR(std::max(all[0], all[1]), 0.94, 0.01) << by;
        const Vec2 half = filled_part(film, usual_view(film, {{0.5 * 4.0 / 3.0, 1.0}}));
        EXPECT_NEAR(std::max(2.0 * half[0], half[1]), 0.94, 0.01) << by;
    }
}

}  // namespace
}  // namespace lamella::render
