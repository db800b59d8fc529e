#include "lamella/linalg/conjugate_gradient.h"

#include <gtest/gtest.h>

namespace lamella::linalg {
namespace {

/// The second difference on a line, with ends that are held (definite) or free (constants are its kernel).
struct Line {
    bool held;
    void operator()(const std::vector<double>& x, std::vector<double>& y) const {
        const std::size_t n = x.size();
        y.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            const double left = i > 0 ? x[i] - x[i - 1] : held ? x[i] : 0.0;
            const double right = i + 1 < n ? x[i] - x[i + 1] : held ? x[i] : 0.0;
            y[i] = left + right;
        }
    }
};

TEST(ConjugateGradient, SolvesToTheToleranceWithinAsManyStepsAsUnknowns) {
    const std::vector<double> wanted{1, -2, 3, 0.5, 7, -1, 4};
    std::vector<double> b, x(wanted.size(), 0.0);
    Line{true}(wanted, b);
    const IterativeSolution done = conjugate_gradient(Line{true}, {}, b, x, 1e-12, 100);
    EXPECT_LE(done.iterations, 8);
    EXPECT_LE(done.residual, 1e-12);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], wanted[i], 1e-10);
}

TEST(ConjugateGradient, StartsFromTheGivenPoint) {
    const std::vector<double> wanted{1, -2, 3};
    std::vector<double> b, x = wanted;
    Line{true}(wanted, b);
    EXPECT_EQ(conjugate_gradient(Line{true}, {}, b, x, 1e-12, 100).iterations, 0);
    EXPECT_EQ(x, wanted);
}

TEST(ConjugateGradient, LeavesTheKernelOfASemiDefiniteOperatorAlone) {
    std::vector<double> b{1, 0, 0, -1}, x(4, 0.0);
    const IterativeSolution done = conjugate_gradient(Line{false}, {}, b, x, 1e-12, 100);
    EXPECT_LE(done.residual, 1e-12);
    EXPECT_NEAR(x[0] + x[1] + x[2] + x[3], 0.0, 1e-12);
    EXPECT_NEAR(x[0] - x[3], 3.0, 1e-12);
}

TEST(ConjugateGradient, TakesFewerStepsWithTheRightScale) {
    // A diagonal of many sizes: scaled, it is the identity.
    const std::size_t n = 50;
    std::vector<double> diagonal(n), inverse(n), b(n, 1.0), x(n, 0.0), y(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) diagonal[i] = 1.0 + 100.0 * static_cast<double>(i), inverse[i] = 1.0 / diagonal[i];
    const auto apply = [&](const std::vector<double>& u, std::vector<double>& v) {
        v = u;
        for (std::size_t i = 0; i < n; ++i) v[i] *= diagonal[i];
    };
    EXPECT_GT(conjugate_gradient(apply, {}, b, x, 1e-10, 1000).iterations, 10);
    EXPECT_LE(conjugate_gradient(apply, inverse, b, y, 1e-10, 1000).iterations, 2);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(y[i] * diagonal[i], 1.0, 1e-9);
}

TEST(ConjugateGradient, OfNothingIsNothing) {
    std::vector<double> x{3, 4};
    const IterativeSolution done = conjugate_gradient(Line{true}, {}, {0, 0}, x, 1e-12, 100);
    EXPECT_EQ(done.residual, 0.0);
    EXPECT_EQ(x, (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace lamella::linalg
