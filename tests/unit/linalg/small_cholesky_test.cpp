#include "lamella/linalg/small_cholesky.h"

#include <gtest/gtest.h>

namespace lamella::linalg {
namespace {

TEST(SolvePositive, SolvesASystemWithAKnownAnswer) {
    // Only the lower triangle is read.
    std::array<double, 9> a{4.0, 99.0, 99.0, 2.0, 5.0, 99.0, -1.0, 1.0, 3.0};
    const std::array<double, 3> x{1.0, -2.0, 0.5};
    std::array<double, 3> b{4.0 * x[0] + 2.0 * x[1] - x[2], 2.0 * x[0] + 5.0 * x[1] + x[2], -x[0] + x[1] + 3.0 * x[2]};
    ASSERT_TRUE(solve_positive<3>(a, b));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(b[k], x[k], 1e-15);
}

TEST(SolvePositive, SolvesForSeveralRightSidesWithOneFactor) {
    std::array<double, 4> a{4.0, 0.0, 2.0, 5.0};
    ASSERT_TRUE(factor_positive<2>(a));
    for (const std::array<double, 2>& x : {std::array{1.0, 0.0}, std::array{-3.0, 2.0}}) {
        std::array<double, 2> b{4.0 * x[0] + 2.0 * x[1], 2.0 * x[0] + 5.0 * x[1]};
        solve_factored<2>(a, b);
        for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(b[k], x[k], 1e-15);
    }
}

TEST(SolvePositive, RefusesWhatIsNotPositiveDefinite) {
    std::array<double, 2> b{1.0, 1.0};
    std::array<double, 4> singular{1.0, 0.0, 1.0, 1.0};
    EXPECT_FALSE(solve_positive<2>(singular, b));
    std::array<double, 4> indefinite{1.0, 0.0, 2.0, 1.0};
    EXPECT_FALSE(solve_positive<2>(indefinite, b));
}

}  // namespace
}  // namespace lamella::linalg
