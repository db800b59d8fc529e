#include "lamella/film/wire.h"

#include <gtest/gtest.h>

#include <numbers>

namespace lamella::film {
namespace {

TEST(Wire, CarriesItsPointsAlongFromStartToEnd) {
    Wire wire;
    wire.velocity = {{2, 0, 0}};
    wire.start = 1.0;
    wire.end = 3.0;
    const Vec3 x{{0, 5, 7}};
    EXPECT_EQ(wire.carried(x, 0.0, 1.0), x);
    EXPECT_LT(norm(wire.carried(x, 0.0, 2.0) - Vec3{{2, 5, 7}}), 1e-14);
    EXPECT_LT(norm(wire.carried(x, 1.5, 2.0) - Vec3{{1, 5, 7}}), 1e-14);
    EXPECT_LT(norm(wire.carried(x, 0.0, 10.0) - Vec3{{4, 5, 7}}), 1e-14);
    EXPECT_EQ(wire.carried(x, 4.0, 10.0), x);
}

TEST(Wire, TurnsAboutItsMovingCenter) {
    Wire wire;
    wire.center = {{1, 0, 0}};
    wire.velocity = {{0, 0, 3}};
    wire.spin = {{0, 0, 0.5 * std::numbers::pi}};
    EXPECT_LT(norm(wire.carried({{2, 0, 0}}, 0.0, 1.0) - Vec3{{1, 1, 3}}), 1e-14);
    // In two goes as in one.
    const Vec3 x{{0.3, -0.2, 0.9}};
    EXPECT_LT(norm(wire.carried(wire.carried(x, 0.0, 0.4), 0.4, 1.3) - wire.carried(x, 0.0, 1.3)), 1e-14);
    EXPECT_LT(norm(wire.carried(wire.carried(x, 0.0, 1.3), 1.3, 0.0) - x), 1e-14);
}

TEST(Wire, AtRestStaysToTheBit) {
    const Wire wire;
    const Vec3 x{{0.1, 0.2, 0.3}};
    EXPECT_FALSE(wire.moves());
    EXPECT_EQ(wire.carried(x, 0.0, 1e9), x);
}

}  // namespace
}  // namespace lamella::film
