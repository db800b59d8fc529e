#include "lamella/solvers/equilibrium/patch_energy.h"

#include "lamella/core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella::equilibrium {
namespace {

std::array<Vec3, 6> bent_patch() {
    return {{{{0.1, 0.2, 0.3}}, {{1.1, 0.1, 0.2}}, {{0.3, 1.3, -0.1}}, {{0.6, 0.1, 0.45}}, {{0.75, 0.7, 0.2}},
             {{0.15, 0.8, 0.25}}}};
}

TEST(Shape, TakesOneAtItsOwnNodeAndAddsUpToOne) {
    for (const int nodes : {3, 6})
        for (std::size_t k = 0; k < static_cast<std::size_t>(nodes); ++k) {
            const auto [u, v] = node_place(k);
            const ShapePoint at = shape_at(nodes, u, v);
            double sum = 0.0, along_u = 0.0, along_v = 0.0;
            for (std::size_t i = 0; i < static_cast<std::size_t>(nodes); ++i) {
                EXPECT_NEAR(at.shape[i], i == k ? 1.0 : 0.0, 1e-15);
                sum += at.shape[i];
                along_u += at.along_u[i];
                along_v += at.along_v[i];
            }
            EXPECT_NEAR(sum, 1.0, 1e-15);
            EXPECT_NEAR(along_u, 0.0, 1e-15);
            EXPECT_NEAR(along_v, 0.0, 1e-15);
        }
}

TEST(PatchMeasures, OfAFlatPatchAreThoseOfATriangle) {
    const auto x = bent_patch();
    const PatchMeasures m = measure_patch(3, x);
    const Vec3 n = cross(x[1] - x[0], x[2] - x[0]);
    EXPECT_NEAR(m.area, 0.5 * norm(n), 1e-15);
    EXPECT_NEAR(m.volume, dot(x[0], cross(x[1], x[2])) / 6.0, 1e-15);
}

TEST(PatchMeasures, OfAQuadraticPatchWithStraightEdgesAreThoseOfTheFlatOne) {
    auto x = bent_patch();
    for (std::size_t k = 0; k < 3; ++k) x[3 + k] = 0.5 * (x[k] + x[(k + 1) % 3]);
    EXPECT_NEAR(measure_patch(6, x).area, measure_patch(3, x).area, 1e-15);
    EXPECT_NEAR(measure_patch(6, x).volume, measure_patch(3, x).volume, 1e-15);
}

TEST(PatchMeasures, AreaSlopeIsTheDifferenceQuotient) {
    for (const int nodes : {3, 6}) {
        const auto x = bent_patch();
        const PatchMeasures m = measure_patch(nodes, x);
        for (std::size_t i = 0; i < static_cast<std::size_t>(nodes); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                constexpr double kStep = 1e-5;  // truncation 1e-10, rounding 1e-11
                auto up = x, down = x;
                up[i][k] += kStep;
                down[i][k] -= kStep;
                const double quotient = (measure_patch(nodes, up).area - measure_patch(nodes, down).area) / (2 * kStep);
                EXPECT_NEAR(m.area_slope[i][k], quotient, 1e-8);
            }
    }
}

TEST(PatchHessian, IsTheSymmetricDifferenceQuotientOfSlopeAndFlux) {
    constexpr double kTension = 1.3, kPressure = 0.7, kStep = 1e-5;
    for (const int nodes : {3, 6}) {
        const auto n = static_cast<std::size_t>(nodes);
        const auto x = bent_patch();
        std::array<Matrix3, 36> block;
        patch_hessian(nodes, x, kTension, kPressure, block);
        // d (tension * area_slope_i - pressure * flux_i) / d x_j
        const auto quotient = [&](std::size_t i, std::size_t r, std::size_t j, std::size_t c) {
            auto up = x, down = x;
            up[j][c] += kStep;
            down[j][c] -= kStep;
            const PatchMeasures a = measure_patch(nodes, up), b = measure_patch(nodes, down);
            return (kTension * (a.area_slope[i][r] - b.area_slope[i][r]) - kPressure * (a.flux[i][r] - b.flux[i][r])) /
                   (2 * kStep);
        };
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j)
                for (std::size_t r = 0; r < 3; ++r)
                    for (std::size_t c = 0; c < 3; ++c)
                        EXPECT_NEAR(block[i * 6 + j][r][c], 0.5 * (quotient(i, r, j, c) + quotient(j, c, i, r)), 1e-8)
                            << nodes << " nodes, " << i << ", " << j;
    }
}

}  // namespace
}  // namespace lamella::equilibrium
