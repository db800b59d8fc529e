#include "lamella/core/vec.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace lamella {
namespace {

TEST(Vec, StartsAtZeroAndIsPlainMemory) {
    EXPECT_EQ(Vec3(), (Vec3{{0.0, 0.0, 0.0}}));
    static_assert(sizeof(Vec2) == 2 * sizeof(double) && sizeof(Vec3) == 3 * sizeof(double));
    static_assert(std::is_trivially_copyable_v<Vec3>);
}

TEST(Vec, AddsSubtractsAndScalesByComponent) {
    const Vec3 a{{1.0, 2.0, 3.0}};
    const Vec3 b{{10.0, 20.0, -30.0}};
    EXPECT_EQ(a + b, (Vec3{{11.0, 22.0, -27.0}}));
    EXPECT_EQ(a - b, (Vec3{{-9.0, -18.0, 33.0}}));
    EXPECT_EQ(-a, (Vec3{{-1.0, -2.0, -3.0}}));
    EXPECT_EQ(2.0 * a, (Vec3{{2.0, 4.0, 6.0}}));
    EXPECT_EQ(a * 2.0, 2.0 * a);
    EXPECT_EQ(a / 2.0, (Vec3{{0.5, 1.0, 1.5}}));
}

TEST(Vec, ChangesInPlaceAndReturnsItself) {
    Vec2 a{{1.0, 2.0}};
    a += Vec2{{1.0, 1.0}};
    EXPECT_EQ(a, (Vec2{{2.0, 3.0}}));
    a -= Vec2{{2.0, 0.0}};
    EXPECT_EQ(a, (Vec2{{0.0, 3.0}}));
    EXPECT_EQ(&(a *= 2.0), &a);
    EXPECT_EQ(a, (Vec2{{0.0, 6.0}}));
    a[0] = 5.0;
    EXPECT_EQ(a[0] + a[1], 11.0);
}

TEST(Vec, ComparesEveryComponent) {
    EXPECT_NE((Vec2{{1.0, 2.0}}), (Vec2{{1.0, 3.0}}));
    EXPECT_NE((Vec2{{0.0, 2.0}}), (Vec2{{1.0, 2.0}}));
}

TEST(Vec, HasAnInnerProductAndANorm) {
    const Vec3 a{{2.0, 3.0, 6.0}};
    EXPECT_EQ(dot(a, Vec3{{1.0, -1.0, 2.0}}), 11.0);
    EXPECT_EQ(squared_norm(a), 49.0);
    EXPECT_EQ(norm(a), 7.0);
    EXPECT_EQ(norm(Vec2{{3.0, 4.0}}), 5.0);
}

TEST(Cross, IsRightHandedAntisymmetricAndNormalToBoth) {
    const Vec3 x{{1.0, 0.0, 0.0}}, y{{0.0, 1.0, 0.0}}, z{{0.0, 0.0, 1.0}};
    EXPECT_EQ(cross(x, y), z);
    EXPECT_EQ(cross(y, z), x);
    EXPECT_EQ(cross(z, x), y);
    const Vec3 a{{1.0, 2.0, 3.0}}, b{{-4.0, 5.0, 7.0}};  // whole numbers: exact
    EXPECT_EQ(cross(a, b), -cross(b, a));
    EXPECT_EQ(dot(cross(a, b), a), 0.0);
    EXPECT_EQ(dot(cross(a, b), b), 0.0);
    EXPECT_EQ(squared_norm(cross(a, b)), squared_norm(a) * squared_norm(b) - dot(a, b) * dot(a, b));
}

}  // namespace
}  // namespace lamella
