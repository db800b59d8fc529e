#include "lamella/solvers/melp/operators.h"

#include "lamella/core/random.h"
#include "lamella/solvers/melp/start.h"
#include "lamella/solvers/melp/volumes.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::melp {
namespace {

/// Particles along Fibonacci's spiral on a sphere, moved along it at random by up to `jitter` spacings.
CoarseParticles sphere(std::size_t count, double radius, double jitter = 0.0) {
    CoarseParticles coarse;
    const double spacing = std::sqrt(4.0 * std::numbers::pi / static_cast<double>(count));
    std::vector<Vec3> points = fibonacci_sphere(count);
    for (std::size_t i = 0; i < count; ++i) {
        Vec3& n = points[i];
        n += (jitter * spacing) *
             (2.0 * uniform_vector<3>(random_bits(1, RandomStream::kMeshJitter, 0, i)) - Vec3{{1, 1, 1}});
        n = n / norm(n);
        coarse.position.push_back(radius * n);
    }
    coarse.frame_normal = points;
    coarse.velocity.resize(count);
    coarse.region.resize(count, 0);
    return coarse;
}

double spacing_of(std::size_t count, double radius) {
    return radius * std::sqrt(4.0 * std::numbers::pi / static_cast<double>(count));
}

Geometry geometry(const CoarseParticles& coarse, double radius, double reach) {
    return geometry_of(coarse, reach * spacing_of(coarse.size(), radius));
}

/// A flat square of particles, 1 m long, in the plane of two given directions; every second row is moved by half.
CoarseParticles plate(std::size_t per_side, const Frame& frame) {
    CoarseParticles coarse;
    const double h = 1.0 / static_cast<double>(per_side);
    for (std::size_t i = 0; i < per_side; ++i)
        for (std::size_t j = 0; j < per_side; ++j)
            coarse.position.push_back((static_cast<double>(i) + (j % 2 == 0 ? 0.0 : 0.5)) * h * frame.e1 +
                                      static_cast<double>(j) * h * frame.e2);
    coarse.frame_normal.assign(coarse.position.size(), frame.normal);
    coarse.velocity.resize(coarse.position.size());
    coarse.region.resize(coarse.position.size(), 0);
    return coarse;
}

/// Two square plates of particles that meet on the y axis at an angle, uneven by up to `jitter` spacings.
CoarseParticles fold(std::size_t per_side, double angle, double jitter) {
    CoarseParticles coarse;
    const double h = 1.0 / static_cast<double>(per_side), half = 0.5 * angle;
    for (const double side : {1.0, -1.0}) {
        const Vec3 down{{side * std::sin(half), 0.0, -std::cos(half)}};
        for (std::size_t i = side > 0.0 ? 0 : 1; i < per_side; ++i)
            for (std::size_t j = 0; j < per_side; ++j) {
                const std::size_t number = coarse.position.size();
                const Vec3 off =
                    2.0 * uniform_vector<3>(random_bits(1, RandomStream::kMeshJitter, 0, number)) - Vec3{{1, 1, 1}};
                coarse.position.push_back((static_cast<double>(i) + jitter * off[0]) * h * down +
                                          (static_cast<double>(j) + jitter * off[1]) * h * Vec3{{0, 1, 0}});
                coarse.frame_normal.push_back(i == 0 ? Vec3{{0, 0, 1}}
                                                     : Vec3{{side * std::cos(half), 0.0, std::sin(half)}});
            }
    }
    coarse.velocity.resize(coarse.position.size());
    coarse.region.resize(coarse.position.size(), 0);
    return coarse;
}

TEST(FilmKernel, HasTheIntegralOneOverThePlane) {
    const FilmKernel kernel{0.7};
    constexpr int kSteps = 20000;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) {
        const double d = (k + 0.5) * 0.7 / kSteps;
        sum += kernel.value(d * d) * 2.0 * std::numbers::pi * d * 0.7 / kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-7);  // the midpoint rule's error
}

TEST(FilmKernel, HasItsSlopeAsTheLaplaciansWeight) {
    const FilmKernel kernel{0.7};
    for (const double q : {0.01, 0.1, 0.3, 0.34, 0.5, 0.66, 0.7, 0.9, 0.99}) {
        const double d = 0.7 * q, step = 1e-5 * d;
        const double slope =
            (kernel.value((d + step) * (d + step)) - kernel.value((d - step) * (d - step))) / (2.0 * step);
        EXPECT_NEAR(kernel.laplacian_weight(d * d), -2.0 * slope / d, 2e-5 * kernel.laplacian_weight(0.0)) << q;
    }
    EXPECT_EQ(kernel.value(0.72 * 0.72), 0.0);
    EXPECT_EQ(kernel.laplacian_weight(0.72 * 0.72), 0.0);
}

/// The rows of [method sheet 16.1] for 2562 particles at r = 4 spacings.
TEST(Operators, HaveTheErrorsOfTheTableOnEvenLayouts) {
    constexpr double kR = 0.05;
    const double exact = 4.0 * std::numbers::pi * kR * kR;
    const CoarseParticles coarse = sphere(2562, kR);
    const Geometry g = geometry(coarse, kR, 4.0);
    EXPECT_NEAR(total(g.area) / exact, 1.0, 1e-4);  // table: -0.007 %
    std::vector<double> z(coarse.size());
    double mean = 0.0, worst = 0.0, square = 0.0;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const Neighbors& same = g.neighbors.same;
        double k = 0.0;
        for (std::size_t p = same.begin(i); p < same.end(i); ++p)
            k += g.area[same.index[p]] * same.laplacian[p] *
                 dot(coarse.position[same.index[p]] - coarse.position[i], g.normal[i]);
        const double error = k / (-2.0 / kR) - 1.0;
        mean += error / 2562.0;
        square += error * error / 2562.0;
        worst = std::max(worst, std::abs(error));
    }
    EXPECT_NEAR(mean, 0.0, 4e-4);          // table: +0.02 %
    EXPECT_LT(std::sqrt(square), 1.5e-3);  // table: 0.07 %
    EXPECT_LT(worst, 1e-2);                // table: 0.7 %
    const std::vector<Gas> gas{{.volume = 1.0}};
    EXPECT_NEAR(particle_volumes(coarse, g, {}, gas, {})[0] / (exact * kR / 3.0), 1.0, 1e-4);  // table: -0.007 %
}

TEST(Operators, LoseAccuracyToDisorderAsTheTableSays) {
    constexpr double kR = 0.05;
    const double exact = 4.0 * std::numbers::pi * kR * kR;
    // A jitter uniform in a cube of +-j has, along the film, the variance of the table's within a factor: the rows
    // bound it.
    const Geometry g = geometry(sphere(2562, kR, 0.3), kR, 4.0);
    const double error = total(g.area) / exact - 1.0;
    EXPECT_LT(error, -0.005);
    EXPECT_GT(error, -0.03);  // table: -1.83 %
}

TEST(Operators, TakeCurvatureFromPatchesToAThousandth) {
    constexpr double kR = 0.05;
    for (const double jitter : {0.0, 0.3}) {
        const CoarseParticles coarse = sphere(2562, kR, jitter);
        const Geometry g = geometry(coarse, kR, 3.0);
        for (std::size_t i = 0; i < g.size(); ++i) {
            EXPECT_NEAR(g.curvature[i] / (-2.0 / kR), 1.0, 1e-2) << jitter;  // [method sheet 16.1]: bias 0.3 %
            EXPECT_GT(dot(g.normal[i], coarse.position[i]) / kR, 1.0 - 1e-5);
        }
    }
}

TEST(Operators, ConvergeWithTheSquareOfTheSpacing) {
    constexpr double kR = 1.0;
    std::vector<double> error;
    for (const std::size_t count : {600, 2400, 9600}) {
        const CoarseParticles coarse = sphere(count, kR);
        const Geometry g = geometry(coarse, kR, 4.0);
        std::vector<double> y(count);  // a spherical harmonic of degree 2: its Laplacian is -6 times itself
        for (std::size_t i = 0; i < count; ++i) y[i] = coarse.position[i][0] * coarse.position[i][1];
        const std::vector<double> lap = laplacian(g, y);
        double sum = 0.0;
        for (std::size_t i = 0; i < count; ++i) sum += std::pow(lap[i] + 6.0 * y[i], 2) / static_cast<double>(count);
        error.push_back(std::sqrt(sum));
    }
    // The kernel's own error is of second order; the layout's part is a tenth of it at the coarsest.
    EXPECT_GT(std::log2(error[0] / error[1]), 1.7);
    EXPECT_GT(std::log2(error[1] / error[2]), 1.5);
}

TEST(Operators, AreExactForLinearFieldsOnAFlatFilmAtItsEdgeToo) {
    const Frame frame = frame_of(Vec3{{0.48, -0.6, 0.64}});
    const CoarseParticles coarse = plate(12, frame);
    const Geometry g = geometry_of(coarse, 0.3);
    const Vec3 slope = 2.0 * frame.e1 - 3.0 * frame.e2;
    std::vector<double> q;
    std::vector<Vec3> w;
    for (const Vec3& x : coarse.position) {
        q.push_back(5.0 + dot(slope, x));
        w.push_back(dot(frame.e1, x) * (4.0 * frame.e1 + frame.normal) + dot(frame.e2, x) * frame.e2);
    }
    for (const Vec3& gradient_of_q : gradient(g, coarse.position, q)) EXPECT_LT(norm(gradient_of_q - slope), 1e-11);
    for (const double d : divergence(g, coarse.position, w)) EXPECT_NEAR(d, 5.0, 1e-11);
}

TEST(Operators, SeeAGrowingSphereStretch) {
    constexpr double kR = 0.05;
    const CoarseParticles coarse = sphere(2562, kR);
    const Geometry g = geometry(coarse, kR, 3.0);
    for (const double d : divergence(g, coarse.position, g.normal)) EXPECT_NEAR(d, 2.0 / kR, 0.02 * 2.0 / kR);
}

TEST(Neighbors, AreTheSameSeenFromBothSides) {
    CoarseParticles coarse = sphere(400, 1.0, 0.3);
    for (std::size_t i = 0; i < coarse.size(); ++i) coarse.region[i] = i % 3 == 0 ? 1 : 0;
    const NeighborLists lists = find_neighbors(coarse.position, coarse.frame_normal, coarse.region, 0.5);
    for (const Neighbors* list : {&lists.same, &lists.other})
        for (std::size_t i = 0; i < list->size(); ++i)
            for (std::size_t k = list->begin(i); k < list->end(i); ++k) {
                const std::size_t j = list->index[k];
                const auto row = list->index.begin() + static_cast<std::ptrdiff_t>(list->begin(j));
                const auto end = list->index.begin() + static_cast<std::ptrdiff_t>(list->end(j));
                const auto back = std::find(row, end, static_cast<std::uint32_t>(i));
                ASSERT_TRUE(back != end);
                const auto at = static_cast<std::size_t>(back - list->index.begin());
                EXPECT_EQ(list->weight[k], list->weight[at]);
                EXPECT_EQ(list->laplacian[k], list->laplacian[at]);
                EXPECT_EQ(list == &lists.same, coarse.region[i] == coarse.region[j]);
            }
}

TEST(Neighbors, AddProductsOverRowsOfAnyLength) {
    const CoarseParticles coarse = sphere(300, 1.0, 0.3);
    const Neighbors same = find_neighbors(coarse.position, coarse.frame_normal, coarse.region, 0.45).same;
    std::vector<float> a, b;
    for (std::size_t k = 0; k < same.index.size(); ++k) {
        a.push_back(std::sin(static_cast<float>(k)));
        b.push_back(std::cos(static_cast<float>(k)));
    }
    std::vector<double> v, w;
    for (std::size_t i = 0; i < same.size(); ++i) {
        v.push_back(std::sin(3.0 + static_cast<double>(i)));
    }
    for (std::size_t i = 0; i < same.size(); ++i) {
        double av = 0.0, bv = 0.0;
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
            av += double{a[k]} * v[same.index[k]];
            bv += double{b[k]} * v[same.index[k]];
        }
        const auto both = sums_of_products<std::vector<float>>(same, {&a, &b}, v, i);
        EXPECT_NEAR(both[0], av, 1e-13);
        EXPECT_NEAR(both[1], bv, 1e-13);
        EXPECT_EQ(sum_of_products(same, a, v, i), both[0]);
    }
}

TEST(Neighbors, DoNotSeeTheOtherSideOfAPinchedFilm) {
    CoarseParticles coarse = plate(10, frame_of(Vec3{{0, 0, 1}}));
    const std::size_t layer = coarse.size();
    for (std::size_t i = 0; i < layer; ++i) {
        coarse.position.push_back(coarse.position[i] - Vec3{{0, 0, 0.05}});
        coarse.frame_normal.push_back({{0, 0, -1}});
        coarse.region.push_back(0);
    }
    const NeighborLists lists = find_neighbors(coarse.position, coarse.frame_normal, coarse.region, 0.3);
    for (std::size_t i = 0; i < lists.same.size(); ++i)
        for (std::size_t k = lists.same.begin(i); k < lists.same.end(i); ++k)
            EXPECT_EQ(i < layer, lists.same.index[k] < layer);
}

/// Normals of the last step choose the neighbors and the planes of the fits in the next one: at a fold they swung from
/// face to face, and particles there were pulled out of their film.
TEST(Geometry, HasNormalsOnFoldsThatStayWhereTheyAre) {
    constexpr std::size_t kPerSide = 20;
    for (const double degrees : {120.0, 100.0, 80.0}) {
        CoarseParticles coarse = fold(kPerSide, degrees * std::numbers::pi / 180.0, 0.2);
        double change = 0.0;
        Geometry before = geometry_of(coarse, 3.0 / kPerSide);
        for (int step = 0; step < 30; ++step) {
            coarse.frame_normal = steady_normals(before, coarse.frame_normal);
            Geometry now = geometry_of(coarse, 3.0 / kPerSide);
            change = 0.0;
            for (std::size_t i = 0; i < now.size(); ++i)
                change = std::max(change, norm(now.normal[i] - before.normal[i]));
            before = std::move(now);
        }
        EXPECT_LT(change, 1e-2) << degrees;
        double lowest = 1.0;
        for (std::size_t i = 0; i < before.size(); ++i)
            if (coarse.frame_normal[i][2] > 0.0 && coarse.position[i][2] > -1.0 / kPerSide)
                lowest = std::min(lowest, before.normal[i][2]);
        EXPECT_GT(lowest, std::sin(0.5 * degrees * std::numbers::pi / 180.0) - 0.05) << degrees;
        std::printf("fold of %.0f degrees: change %.2g, lowest at the ridge %.3f\n", degrees, change, lowest);
    }
}

}  // namespace
}  // namespace lamella::melp
