#include "lamella/geometry/curved_triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lamella::geometry {
namespace {

TEST(CurvedTriangle, LeavesItsEdgeAsTheParaboloidItLiesOnDoes) {
    // z = a x^2 + b x y + c y^2 over any triangle: a quadratic triangle is exact, and so is its tangent plane.
    const auto lift = [](double x, double y) { return Vec3{{x, y, 0.3 * x * x - 0.2 * x * y + 0.5 * y * y}}; };
    const Vec3 p0 = lift(0.1, 0.2), p1 = lift(1.3, 0.4), p2 = lift(0.5, 1.1);
    const auto middle = [&](const Vec3& a, const Vec3& b) { return lift(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])); };
    const CurvedTriangle x{p0, p1, p2, middle(p0, p1), middle(p1, p2), middle(p2, p0)};
    for (std::size_t opposite = 0; opposite < 3; ++opposite) {
        const Vec3 out = edge_conormal(x, opposite);
        const std::size_t tail = (opposite + 1) % 3, head = (opposite + 2) % 3;
        const Vec3 at = x[3 + tail];
        const Vec3 normal{{-(0.6 * at[0] - 0.2 * at[1]), -(-0.2 * at[0] + 1.0 * at[1]), 1.0}};
        EXPECT_NEAR(dot(out, normal), 0.0, 1e-14);              // tangent to the paraboloid
        EXPECT_NEAR(dot(out, x[head] - x[tail]), 0.0, 1e-14);   // perpendicular to the edge
        EXPECT_GT(dot(out, x[opposite] - at), 0.0);             // into the triangle
    }
}

TEST(CurvedTriangle, PassesThroughItsPointsAndLiesOnItsParaboloid) {
    const auto lift = [](double x, double y) { return Vec3{{x, y, 0.3 * x * x - 0.2 * x * y + 0.5 * y * y}}; };
    const Vec3 p0 = lift(0.1, 0.2), p1 = lift(1.3, 0.4), p2 = lift(0.5, 1.1);
    const auto middle = [&](const Vec3& a, const Vec3& b) { return lift(0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])); };
    const CurvedTriangle x{p0, p1, p2, middle(p0, p1), middle(p1, p2), middle(p2, p0)};
    EXPECT_NEAR(norm(point_on(x, {0.0, 1.0, 0.0}) - p1), 0.0, 1e-15);
    EXPECT_NEAR(norm(point_on(x, {0.0, 0.5, 0.5}) - x[4]), 0.0, 1e-15);
    const Vec3 at = point_on(x, {0.2, 0.3, 0.5});
    EXPECT_NEAR(norm(at - lift(0.2 * 0.1 + 0.3 * 1.3 + 0.5 * 0.5, 0.2 * 0.2 + 0.3 * 0.4 + 0.5 * 1.1)), 0.0, 1e-15);
}

TEST(CurvedTriangle, OfAFlatTriangleLeavesInItsPlane) {
    const Vec3 a{}, b{{2.0, 0.0, 0.0}}, c{{0.5, 1.5, 0.0}};
    const CurvedTriangle x{a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)};
    const Vec3 out = edge_conormal(x, 2);
    EXPECT_NEAR(out[0], 0.0, 1e-15);
    EXPECT_NEAR(out[1], 1.5, 1e-15);
}

double angle_off(const Vec3& tangent, const Vec3& exact) {
    return std::atan2(norm(cross(tangent, exact)), dot(tangent, exact));
}

std::vector<Vec3> arc(std::size_t points, double step) {
    std::vector<Vec3> x;
    for (std::size_t k = 0; k < points; ++k) {
        const double t = step * static_cast<double>(k);
        x.push_back({{std::cos(t), std::sin(t), 0.0}});
    }
    return x;
}

TEST(EndTangent, OfAStraightLineIsItsDirection) {
    const std::vector<Vec3> line{{{0.0, 1.0, 0.0}}, {{0.1, 1.2, 0.0}}, {{0.3, 1.6, 0.0}}, {{0.35, 1.7, 0.0}}};
    for (const std::size_t degree : {1U, 2U, 3U, 7U})
        EXPECT_NEAR(angle_off(end_tangent(line, degree), {{1.0, 2.0, 0.0}}), 0.0, 1e-12);
}

TEST(EndTangent, OfAnArcConvergesWithTheOrderOfItsPolynomial) {
    const Vec3 exact{{0.0, 1.0, 0.0}};
    const auto error = [&](double step, std::size_t degree) { return angle_off(end_tangent(arc(5, step), degree), exact); };
    // What a line misses of the arc is t^2 / 2 across its start, what a parabola or a cubic misses t^4 / 24: slopes of
    // order 1 and 3.
    EXPECT_NEAR(std::log2(error(0.1, 1) / error(0.05, 1)), 1.0, 0.1);
    EXPECT_NEAR(std::log2(error(0.1, 2) / error(0.05, 2)), 3.0, 0.2);
    EXPECT_NEAR(std::log2(error(0.1, 3) / error(0.05, 3)), 3.0, 0.2);
    EXPECT_LT(error(0.05, 3), 1e-4);
}

}  // namespace
}  // namespace lamella::geometry
