#include "lamella/geometry/predicates.h"

#include <gtest/gtest.h>

#include <random>

namespace lamella::geometry {
namespace {

using Wide = __int128;

struct Point {
    long v[3];
};

Vec3 scaled(const Point& p, double unit) {
    return {{static_cast<double>(p.v[0]) * unit, static_cast<double>(p.v[1]) * unit, static_cast<double>(p.v[2]) * unit}};
}

int sign(Wide x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// The same determinant in integers; no rounding for coordinates below 2^38.
int oracle(const Point& a, const Point& b, const Point& c, const Point& d) {
    Wide u[3], v[3], w[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = b.v[k] - a.v[k];
        v[k] = c.v[k] - a.v[k];
        w[k] = d.v[k] - a.v[k];
    }
    return sign(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]));
}

TEST(Orient3d, IsOneOnTheSideThatTheNormalPointsTo) {
    EXPECT_EQ(orient3d({{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}), 1);
    EXPECT_EQ(orient3d({{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, -1}}), -1);
    EXPECT_EQ(orient3d({{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{5, 7, 0}}), 0);
}

TEST(Orient3d, AgreesWithIntegersOnASmallGrid) {
    std::mt19937 random(1);
    std::uniform_int_distribution<long> coordinate(-2, 2);
    int zeros = 0;
    for (int n = 0; n < 100000; ++n) {
        Point p[4];
        for (Point& q : p)
            for (long& x : q.v) x = coordinate(random);
        const int expected = oracle(p[0], p[1], p[2], p[3]);
        zeros += expected == 0;
        ASSERT_EQ(orient3d(scaled(p[0], 0.1), scaled(p[1], 0.1), scaled(p[2], 0.1), scaled(p[3], 0.1)) == 0 ? 0 : 1,
                  orient3d(scaled(p[1], 0.1), scaled(p[0], 0.1), scaled(p[2], 0.1), scaled(p[3], 0.1)) == 0 ? 0 : 1);
        ASSERT_EQ(orient3d(scaled(p[0], 0.125), scaled(p[1], 0.125), scaled(p[2], 0.125), scaled(p[3], 0.125)), expected);
    }
    EXPECT_GT(zeros, 1000);
}

TEST(Orient3d, IsExactOneUnitInTheLastPlaceFromAPlane) {
    // Points of a plane with integer coordinates up to 2^36, then each moved by -1, 0 or 1 unit: the determinant is
    // far below what rounding leaves of it.
    std::mt19937_64 random(2);
    std::uniform_int_distribution<long> coordinate(-(1L << 34), 1L << 34);
    std::uniform_int_distribution<long> step(-1, 1);
    int counts[3] = {};
    for (int n = 0; n < 20000; ++n) {
        Point a, b, c, d;
        for (int k = 0; k < 3; ++k) {
            a.v[k] = coordinate(random);
            b.v[k] = coordinate(random);
            c.v[k] = coordinate(random);
            d.v[k] = a.v[k] + (b.v[k] - a.v[k]) + (c.v[k] - a.v[k]) + (n % 2 == 0 ? step(random) : 0);
        }
        const int expected = oracle(a, b, c, d);
        ++counts[expected + 1];
        const double unit = std::ldexp(1.0, -40);
        ASSERT_EQ(orient3d(scaled(a, unit), scaled(b, unit), scaled(c, unit), scaled(d, unit)), expected);
        ASSERT_EQ(orient3d(scaled(b, unit), scaled(a, unit), scaled(c, unit), scaled(d, unit)), -expected);
        ASSERT_EQ(orient3d(scaled(d, unit), scaled(a, unit), scaled(b, unit), scaled(c, unit)), -expected);
    }
    for (const int count : counts) EXPECT_GT(count, 1000);
}

TEST(Orient3d, KeepsDifferencesThatAreNoDoubles) {
    // a lies far out, so that b - a and the like are rounded: only expansions of the differences themselves are exact.
    const double far = 1e17;
    const double tiny = 1e-17;
    EXPECT_EQ(orient3d({{far, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{tiny, 0.5, 0.5}}),
              -orient3d({{far, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{-tiny, 0.5, 0.5}}));
    EXPECT_NE(orient3d({{far, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{tiny, 0.5, 0.5}}), 0);
    EXPECT_EQ(orient3d({{far, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{0, 0.5, 0.5}}), 0);
}

TEST(Orient2d, IsExactOneUnitInTheLastPlaceFromALine) {
    std::mt19937_64 random(3);
    std::uniform_int_distribution<long> coordinate(-(1L << 40), 1L << 40);
    std::uniform_int_distribution<long> step(-1, 1);
    for (int n = 0; n < 20000; ++n) {
        long a[2], b[2], c[2];
        for (int k = 0; k < 2; ++k) {
            a[k] = coordinate(random);
            b[k] = coordinate(random);
            c[k] = 3 * b[k] - 2 * a[k] + step(random);
        }
        const int expected = sign(Wide(b[0] - a[0]) * (c[1] - a[1]) - Wide(b[1] - a[1]) * (c[0] - a[0]));
        const auto at = [](const long (&p)[2]) { return Vec2{{static_cast<double>(p[0]), static_cast<double>(p[1])}}; };
        ASSERT_EQ(orient2d(at(a), at(b), at(c)), expected);
    }
}

}  // namespace
}  // namespace lamella::geometry
