#include "lamella/core/parallel.h"
#include "lamella/core/random.h"
#include "lamella/spatial/vortex_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::spatial {
namespace {

using Method = VortexSumOptions::Method;
using Precision = VortexSumOptions::Precision;

struct Elements {
    std::vector<Vec3> centers, strengths;
    double spacing;
};

/// Spheres of radius 1 at the corners of a cube of edge 1.9, so that they overlap a little as the bubbles of a cluster;
/// each with points on a Fibonacci spiral and a smooth tangential sheet strength.
Elements spheres(std::size_t count, std::size_t points) {
    Elements e;
    const double area = 4.0 * std::numbers::pi / static_cast<double>(points);
    e.spacing = std::sqrt(area);
    for (std::size_t s = 0; s < count; ++s)
        for (std::size_t i = 0; i < points; ++i) {
            const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(points);
            const double angle = static_cast<double>(i) * std::numbers::pi * (3.0 - std::sqrt(5.0));
            const double rho = std::sqrt(1.0 - z * z);
            const Vec3 n{{rho * std::cos(angle), rho * std::sin(angle), z}};
            const Vec3 corner{{1.9 * static_cast<double>(s & 1), 1.9 * static_cast<double>(s >> 1 & 1),
                               1.9 * static_cast<double>(s >> 2)}};
            e.centers.push_back(corner + n);
            e.strengths.push_back(area * cross(n, Vec3{{n[1], n[2] * n[0], 1.0 + 0.3 * static_cast<double>(s)}}));
        }
    return e;
}

VortexSumOptions by(Method method, double delta, double tolerance = 1e-5, VortexKernel kernel = VortexKernel::kK3) {
    return {.kernel = kernel, .delta = delta, .method = method, .tolerance = tolerance};
}

std::vector<Vec3> every(std::size_t step, const std::vector<Vec3>& all) {
    std::vector<Vec3> some;
    for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
    return some;
}

/// Largest error over the largest value, at every `step`-th point of `found`.
double relative_error(const std::vector<Vec3>& found, const std::vector<Vec3>& expected, std::size_t step = 1) {
    double error = 0.0, largest = 0.0;
    EXPECT_EQ((found.size() + step - 1) / step, expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        error = std::max(error, norm(found[i * step] - expected[i]));
        largest = std::max(largest, norm(expected[i]));
    }
    return error / largest;
}

TEST(VortexTree, MeetsItsToleranceOnSpheresAndClustersOfThem) {
    for (const Elements& e : {spheres(1, 9000), spheres(8, 1200)}) {
        const std::vector<Vec3> some = every(29, e.centers);
        for (const VortexKernel kernel : {VortexKernel::kPlummer, VortexKernel::kK2, VortexKernel::kK3}) {
            const double delta = (kernel == VortexKernel::kPlummer ? 0.75 : 1.5) * e.spacing;
            const VortexField exact =
                vortex_sum(some, e.centers, e.strengths, by(Method::kDirect, delta, 1e-5, kernel), true);
            double coarser = 1.0;
            for (const double tolerance : {1e-1, 1e-3, 1e-4, 1e-5, 1e-6}) {
                if (kernel != VortexKernel::kK3 && tolerance != 1e-4) continue;  // one sample of the others
                const VortexField found =
                    vortex_sum(e.centers, e.centers, e.strengths, by(Method::kTree, delta, tolerance, kernel), true);
                const double error = relative_error(found.velocity, exact.velocity, 29);
                EXPECT_LT(error, tolerance);
                EXPECT_LT(relative_error(found.potential, exact.potential, 29), tolerance);
                EXPECT_LT(error, coarser);  // it is the proxies that err, not a pair left out
                EXPECT_GT(error, 1e-16);    // and the tree did use them
                coarser = error;
            }
        }
    }
}

TEST(VortexTree, MeetsItsToleranceInSinglePrecision) {
    const Elements e = spheres(8, 1000);
    const std::vector<Vec3> some = every(29, e.centers);
    const double delta = 1.5 * e.spacing;
    const VortexField exact = vortex_sum(some, e.centers, e.strengths, by(Method::kDirect, delta), true);
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
        VortexSumOptions options = by(Method::kTree, delta, tolerance);
        options.precision = Precision::kSingle;
        const VortexField found = vortex_sum(e.centers, e.centers, e.strengths, options, true);
        EXPECT_LT(relative_error(found.velocity, exact.velocity, 29), tolerance);
        EXPECT_LT(relative_error(found.potential, exact.potential, 29), tolerance);
    }
}

TEST(VortexTree, MeetsItsToleranceForAnyDelta) {
    const Elements e = spheres(1, 6000);
    const std::vector<Vec3> some = every(29, e.centers);
    for (const double ratio : {0.1, 0.5, 3.0, 10.0, 100.0}) {
        const VortexField exact =
            vortex_sum(some, e.centers, e.strengths, by(Method::kDirect, ratio * e.spacing), true);
        const VortexField found =
            vortex_sum(e.centers, e.centers, e.strengths, by(Method::kTree, ratio * e.spacing), true);
        EXPECT_LT(relative_error(found.velocity, exact.velocity, 29), 1e-5) << ratio;
        EXPECT_LT(relative_error(found.potential, exact.potential, 29), 1e-5) << ratio;
    }
}

TEST(VortexTree, TakesTargetsThatAreNotTheCenters) {
    const Elements e = spheres(8, 1000);
    std::vector<Vec3> targets;
    for (std::size_t i = 0; i < 3000; ++i)
        targets.push_back(6.0 * uniform_vector<3>(random_bits(3, RandomStream::kMeshJitter, 0, i)) -
                          Vec3{{2.0, 2.0, 2.0}});
    targets.push_back({{1e5, 0.0, 0.0}});
    const VortexField exact = vortex_sum(targets, e.centers, e.strengths, by(Method::kDirect, 0.1), true);
    const VortexField found = vortex_sum(targets, e.centers, e.strengths, by(Method::kTree, 0.1), true);
    EXPECT_LT(relative_error(found.velocity, exact.velocity), 1e-5);
    EXPECT_LT(relative_error(found.potential, exact.potential), 1e-5);
}

TEST(VortexTree, TakesPointsOnALineOnAPlaneAndOnTopOfEachOther) {
    std::vector<Vec3> line, plane, heap, strengths;
    for (std::size_t i = 0; i < 3000; ++i) {
        const Vec3 r = uniform_vector<3>(random_bits(4, RandomStream::kMeshJitter, 0, i));
        line.push_back({{r[0], 0.0, 0.0}});
        plane.push_back({{r[0], 2.0, r[1]}});
        heap.push_back({{r[0] < 0.5 ? 0.0 : 1.0, 0.0, r[1] < 0.5 ? 0.0 : 1.0}});  // four places
        strengths.push_back(r);
    }
    for (const std::vector<Vec3>& points : {line, plane, heap}) {
        const VortexField exact = vortex_sum(points, points, strengths, by(Method::kDirect, 0.01), true);
        const VortexField found = vortex_sum(points, points, strengths, by(Method::kTree, 0.01), true);
        EXPECT_LT(relative_error(found.velocity, exact.velocity), 1e-5);
        EXPECT_LT(relative_error(found.potential, exact.potential), 1e-5);
    }
    const std::vector<Vec3> one_place(3000, Vec3{{1.0, 2.0, 3.0}});
    const VortexField still = vortex_sum(one_place, one_place, strengths, by(Method::kTree, 0.01), false);
    for (const Vec3& u : still.velocity) EXPECT_EQ(norm(u), 0.0);
}

TEST(VortexTree, TakesDistancesOfEveryOrderOfMagnitude) {
    // Distances from the middle from 1e-6 to 1e6; strengths grow as the distance squared, as areas do.
    std::vector<Vec3> points, strengths;
    for (std::size_t i = 0; i < 4000; ++i) {
        const double r = std::pow(10.0, -6.0 + 12.0 * static_cast<double>(i) / 4000.0);
        const Vec3 side = uniform_vector<3>(random_bits(5, RandomStream::kMeshJitter, 0, i)) - Vec3{{0.5, 0.5, 0.5}};
        points.push_back(r * side);
        strengths.push_back(r * r * uniform_vector<3>(random_bits(5, RandomStream::kMeshJitter, 1, i)));
    }
    const VortexField exact = vortex_sum(points, points, strengths, by(Method::kDirect, 1e-3), true);
    const VortexField found = vortex_sum(points, points, strengths, by(Method::kTree, 1e-3), true);
    EXPECT_LT(relative_error(found.velocity, exact.velocity), 1e-5);
    EXPECT_LT(relative_error(found.potential, exact.potential), 1e-5);
}

TEST(VortexTree, GivesTheSameBitsOnOneAndTwoThreads) {
    const Elements e = spheres(8, 1000);
    for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
        VortexSumOptions options = by(Method::kTree, 0.1);
        options.precision = precision;
        const auto sum = [&](int threads) {
            const ThreadLimit limit(threads);
            return vortex_sum(e.centers, e.centers, e.strengths, options, true);
        };
        const VortexField one = sum(1), two = sum(2);
        EXPECT_EQ(one.velocity, two.velocity);
        EXPECT_EQ(one.potential, two.potential);
    }
}

TEST(VortexTree, IsChosenForManyPointsOnly) {
    for (const std::size_t points : {500U, 8000U}) {
        const Elements e = spheres(1, points);
        const Method expected = points == 500U ? Method::kDirect : Method::kTree;
        const VortexField automatic =
            vortex_sum(e.centers, e.centers, e.strengths, by(Method::kAuto, 0.1, 1e-3), false);
        const VortexField chosen = vortex_sum(e.centers, e.centers, e.strengths, by(expected, 0.1, 1e-3), false);
        EXPECT_EQ(automatic.velocity, chosen.velocity);
    }
}

TEST(VortexTree, IsEmptyOrAlone) {
    const std::vector<Vec3> none, one{{{1.0, 2.0, 3.0}}};
    EXPECT_TRUE(vortex_sum(none, one, one, by(Method::kTree, 0.1), true).velocity.empty());
    EXPECT_EQ(vortex_sum(one, none, none, by(Method::kTree, 0.1), true).velocity, std::vector<Vec3>(1));
    const VortexField direct = vortex_sum(one, one, one, by(Method::kDirect, 0.1), true);
    EXPECT_EQ(vortex_sum(one, one, one, by(Method::kTree, 0.1), true).potential, direct.potential);
}

}  // namespace
}  // namespace lamella::spatial
