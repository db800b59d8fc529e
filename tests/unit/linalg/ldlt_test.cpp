#include "lamella/linalg/ldlt.h"

#include "lamella/linalg/dense.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella::linalg {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// The matrix of -u'' on a grid of n inner points with spacing 1: eigenvalues 2 - 2 cos(k pi / (n + 1)).
SymmetricMatrix second_difference(int n) {
    Groups pairs;
    for (int i = 0; i + 1 < n; ++i) {
        pairs.member.insert(pairs.member.end(), {i, i + 1});
        pairs.close_group();
    }
    SymmetricMatrix m = coupled(static_cast<std::size_t>(n), pairs);
    for (int i = 0; i < n; ++i) m.value[m.slot(i, i)] = 2.0;
    for (int i = 0; i + 1 < n; ++i) m.value[m.slot(i, i + 1)] = -1.0;
    return m;
}

TEST(SymmetricMatrix, CouplesTheMembersOfGroupsAndNoOthers) {
    Groups groups;
    groups.member = {3, 0, 2};
    groups.close_group();
    groups.member.insert(groups.member.end(), {2, 4});
    groups.close_group();
    const SymmetricMatrix m = coupled(5, groups);
    EXPECT_EQ(m.column_start, (std::vector<int>{0, 3, 4, 7, 8, 9}));
    EXPECT_EQ(m.row, (std::vector<int>{0, 2, 3, 1, 2, 3, 4, 3, 4}));
}

TEST(SymmetricMatrix, MultipliesWithBothTriangles) {
    const SymmetricMatrix m = second_difference(4);
    const std::vector<double> x{1.0, 2.0, 4.0, 8.0};
    std::vector<double> y(4);
    multiply(m, x, y);
    EXPECT_EQ(y, (std::vector<double>{0.0, -1.0, -2.0, 12.0}));
}

TEST(Ldlt, SolvesToRoundOff) {
    const int n = 200;
    const SymmetricMatrix m = second_difference(n);
    std::vector<double> x(n), b(n);
    for (int i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] = std::sin(0.3 * i);
    multiply(m, x, b);
    Ldlt ldlt;
    ldlt.analyze(m);
    ASSERT_TRUE(ldlt.factorize(m));
    EXPECT_EQ(ldlt.negative_pivots(), 0U);
    ldlt.solve(b);
    // Condition number 4 (n/pi)^2 = 16000, times a few roundings.
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(b[i], x[i], 1e-11);
}

TEST(Ldlt, CountsNegativeEigenvalues) {
    const int n = 50;
    for (const double shift : {0.001, 0.1, 0.97, 3.9}) {
        SymmetricMatrix m = second_difference(n);
        std::size_t below = 0;
        for (int k = 1; k <= n; ++k) below += 2.0 - 2.0 * std::cos(k * kPi / (n + 1)) < shift ? 1U : 0U;
        for (int i = 0; i < n; ++i) m.diagonal(static_cast<std::size_t>(i)) -= shift;
        Ldlt ldlt;
        ldlt.analyze(m);
        ASSERT_TRUE(ldlt.factorize(m));
        EXPECT_EQ(ldlt.negative_pivots(), below) << shift;
    }
}

TEST(Ldlt, RefusesASingularMatrix) {
    SymmetricMatrix m = second_difference(3);
    for (double& v : m.value) v = 0.0;
    Ldlt ldlt;
    ldlt.analyze(m);
    EXPECT_FALSE(ldlt.factorize(m));
}

TEST(Dense, FindsEigenpairsOfThreeByThree) {
    // Eigenvalues 1, 2, 4 along (1,-1,0), (0,0,1), (1,1,0).
    const auto pairs = eigenpairs({Vec3{{2.5, 1.5, 0.0}}, Vec3{{1.5, 2.5, 0.0}}, Vec3{{0.0, 0.0, 2.0}}});
    EXPECT_NEAR(pairs.value[0], 1.0, 1e-14);
    EXPECT_NEAR(pairs.value[1], 2.0, 1e-14);
    EXPECT_NEAR(pairs.value[2], 4.0, 1e-14);
    EXPECT_NEAR(std::abs(dot(pairs.vector[2], Vec3{{std::sqrt(0.5), std::sqrt(0.5), 0.0}})), 1.0, 1e-14);
}

TEST(Dense, SolvesAnIndefiniteSingularSystemWithLeastNorm) {
    // diag(2, -3, 0) in a rotated basis is tested through its diagonal form: the null direction gets nothing.
    const std::vector<double> m{2.0, 0.0, 0.0, 0.0, -3.0, 0.0, 0.0, 0.0, 0.0};
    const auto solution = solve_symmetric(3, m, std::vector<double>{4.0, 6.0, 0.0});
    EXPECT_EQ(solution.negative, 1U);
    EXPECT_NEAR(solution.x[0], 2.0, 1e-14);
    EXPECT_NEAR(solution.x[1], -2.0, 1e-14);
    EXPECT_EQ(solution.x[2], 0.0);
}

}  // namespace
}  // namespace lamella::linalg
