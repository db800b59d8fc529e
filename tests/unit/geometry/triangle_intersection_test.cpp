#include "lamella/geometry/triangle_intersection.h"

#include "lamella/geometry/distance.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace lamella::geometry {
namespace {

const Triangle kFlat{{{{0, 0, 0}}, {{4, 0, 0}}, {{0, 4, 0}}}};

TEST(TrianglesMeet, InAPointOnAnEdgeOrInAPlane) {
    struct Case {
        Triangle t;
        bool meet;
    };
    for (const Case& c : {Case{{{{{1, 1, -1}}, {{1, 1, 1}}, {{9, 9, 0}}}}, true},      // pierces
                          Case{{{{{1, 1, 0}}, {{1, 1, 1}}, {{2, 2, 1}}}}, true},       // touches with a corner
                          Case{{{{{1, 1, 1e-30}}, {{1, 1, 1}}, {{2, 2, 1}}}}, false},  // misses by a hair
                          Case{{{{{2, 2, -1}}, {{2, 2, 1}}, {{9, 9, 0}}}}, true},      // through the long edge
                          Case{{{{{2.5, 2, -1}}, {{2, 2.5, 1}}, {{9, 9, 0}}}}, false},
                          Case{{{{{1, 1, 0}}, {{2, 1, 0}}, {{1, 2, 0}}}}, true},        // inside, in the plane
                          Case{{{{{-9, -9, 0}}, {{30, -9, 0}}, {{-9, 30, 0}}}}, true},  // around it, in the plane
                          Case{{{{{5, 5, 0}}, {{6, 5, 0}}, {{5, 6, 0}}}}, false},       // beside it, in the plane
                          Case{{{{{4, 0, 0}}, {{5, 0, 0}}, {{5, 1, 0}}}}, true}})       // corner on corner
    {
        EXPECT_EQ(triangles_meet(kFlat, c.t), c.meet) << c.t[0][0] << " " << c.t[0][1] << " " << c.t[0][2];
        EXPECT_EQ(triangles_meet(c.t, kFlat), c.meet);
    }
}

TEST(TrianglesMeet, WhereverTheirDistanceIsZero) {
    // On a grid of integers two triangles either meet or are at least about 1/100 apart.
    std::mt19937 random(5);
    std::uniform_int_distribution<int> coordinate(0, 3);
    int met = 0;
    for (int n = 0; n < 20000; ++n) {
        Triangle s, t;
        for (Triangle* one : {&s, &t})
            for (Vec3& p : *one)
                for (std::size_t k = 0; k < 3; ++k) p[k] = coordinate(random);
        const auto thin = [](const Triangle& x) { return squared_norm(cross(x[1] - x[0], x[2] - x[0])) == 0.0; };
        if (thin(s) || thin(t)) continue;
        double least = 1e300;
        for (std::size_t i = 0; i < 3; ++i) {
            least = std::min({least, squared_distance_to_triangle(s[i], t[0], t[1], t[2]),
                              squared_distance_to_triangle(t[i], s[0], s[1], s[2])});
            for (std::size_t j = 0; j < 3; ++j)
                least = std::min(least, squared_distance_of_segments(s[i], s[(i + 1) % 3], t[j], t[(j + 1) % 3]));
        }
        // An edge that pierces the other triangle is near none of its edges and corners.
        bool pierced = false;
        for (std::size_t i = 0; i < 3; ++i)
            pierced = pierced || segment_meets_triangle(s[i], s[(i + 1) % 3], t) ||
                      segment_meets_triangle(t[i], t[(i + 1) % 3], s);
        const bool expected = least < 1e-12 || pierced;
        met += expected;
        ASSERT_EQ(triangles_meet(s, t), expected);
        if (least < 1e-12) {
            ASSERT_TRUE(triangles_meet(s, t));
        }
    }
    EXPECT_GT(met, 2000);
}

TEST(TrianglesMeetBeyondShared, KnowsNeighborsFromFolds) {
    const Triangle up{{{{0, 0, 0}}, {{4, 0, 0}}, {{0, 0, 4}}}};
    const Triangle on_top{{{{0, 0, 0}}, {{4, 0, 0}}, {{1, 1, 0}}}};
    const Triangle beside{{{{0, 0, 0}}, {{4, 0, 0}}, {{1, -1, 0}}}};
    EXPECT_FALSE(triangles_meet_beyond_shared(kFlat, up, 2));
    EXPECT_TRUE(triangles_meet_beyond_shared(kFlat, on_top, 2));
    EXPECT_FALSE(triangles_meet_beyond_shared(kFlat, beside, 2));

    const Triangle away{{{{0, 0, 0}}, {{-1, 0, 0}}, {{0, -1, 0}}}};
    const Triangle through{{{{0, 0, 0}}, {{2, 1, -1}}, {{2, 1, 1}}}};
    const Triangle within{{{{0, 0, 0}}, {{1, 0.5, 0}}, {{0.5, 1, 0}}}};
    EXPECT_FALSE(triangles_meet_beyond_shared(kFlat, away, 1));
    EXPECT_TRUE(triangles_meet_beyond_shared(kFlat, through, 1));
    EXPECT_TRUE(triangles_meet_beyond_shared(kFlat, within, 1));
}

TEST(Distance, OfSegmentsIsTheLeastOverTheirPoints) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    for (int n = 0; n < 2000; ++n) {
        std::array<Vec3, 4> p;
        for (Vec3& q : p)
            for (std::size_t k = 0; k < 3; ++k) q[k] = coordinate(random);
        if (n % 4 == 0) p[1] = p[0];                        // a point
        if (n % 4 == 1) p[3] = p[2] + 2.0 * (p[1] - p[0]);  // parallel
        double sampled = 1e300;
        for (int i = 0; i <= 200; ++i)
            sampled = std::min(sampled, squared_distance_to_segment(p[0] + (i / 200.0) * (p[1] - p[0]), p[2], p[3]));
        const double found = squared_distance_of_segments(p[0], p[1], p[2], p[3]);
        ASSERT_LE(found, sampled + 1e-12);
        ASSERT_GE(std::sqrt(found), std::sqrt(sampled) - 0.01);  // half a sample's length
    }
}

TEST(Distance, ToATriangleIsTheLeastOverItsPoints) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    for (int n = 0; n < 2000; ++n) {
        std::array<Vec3, 4> p;
        for (Vec3& q : p)
            for (std::size_t k = 0; k < 3; ++k) q[k] = coordinate(random);
        double sampled = 1e300;
        for (int i = 0; i <= 100; ++i) {
            const double u = i / 100.0;
            sampled = std::min(sampled,
                               squared_distance_to_segment(p[0], p[1] + u * (p[2] - p[1]), p[1] + u * (p[3] - p[1])));
        }
        const double found = squared_distance_to_triangle(p[0], p[1], p[2], p[3]);
        ASSERT_LE(found, sampled + 1e-12);
        ASSERT_GE(std::sqrt(found), std::sqrt(sampled) - 0.03);
    }
}

/// In a frame that is turned, so that coordinates are rounded.
Vec3 turned(double x, double y, double z) {
    const Vec3 a = Vec3{{1, 2, 3}} / std::sqrt(14.0), b = Vec3{{2, -1, 0}} / std::sqrt(5.0);
    return x * a + y * b + z * cross(a, b);
}

TEST(Distance, OfSegmentsThatCrossAtASmallAngleIsThatWhereTheyCross) {
    constexpr double kGap = 1e-10;
    for (double angle = 0.1; angle > 1e-9; angle *= 0.3) {
        const double found = squared_distance_of_segments(
            turned(-0.37, 0, 0), turned(0.63, 0, 0), turned(-0.5, -0.5 * angle, kGap), turned(0.5, 0.5 * angle, kGap));
        EXPECT_NEAR(std::sqrt(found), kGap, 1e-15) << "angle " << angle;
    }
}

TEST(Distance, ToANeedleIsThatToThePointOverWhichOneIs) {
    constexpr double kGap = 1e-10;
    for (double height = 0.1; height > 1e-9; height *= 0.3) {
        const std::array<Vec3, 3> x{turned(0, 0, 0), turned(1, 0, 0), turned(0.6, height, 0)};
        for (std::size_t k = 0; k < 3; ++k) {
            const double found =
                squared_distance_to_triangle(turned(0.43, 0.5 * height, kGap), x[k], x[(k + 1) % 3], x[(k + 2) % 3]);
            EXPECT_NEAR(std::sqrt(found), kGap, 2e-15) << "height " << height << ", first corner " << k;
        }
    }
}

}  // namespace
}  // namespace lamella::geometry
