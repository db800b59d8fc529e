#include "lamella/linalg/definite_solver.h"

#include "lamella/core/error.h"
#include "lamella/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella::linalg {
namespace {

/// The five-point Laplacian of a square of n x n points with value 0 around it, times `scale`, plus `mass`.
SymmetricMatrix laplacian_of_square(int n, double scale, double mass = 0.0) {
    Groups edges;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}}) {
                if (x + dx == n || y + dy == n) continue;
                edges.member.push_back(y * n + x);
                edges.member.push_back((y + dy) * n + x + dx);
                edges.close_group();
            }
    SymmetricMatrix matrix = coupled(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), edges);
    for (std::size_t g = 0; g < edges.size(); ++g) matrix.value[matrix.slot(edges.of(g)[0], edges.of(g)[1])] = -scale;
    for (std::size_t i = 0; i < matrix.size(); ++i) matrix.diagonal(i) = 4.0 * scale + mass;
    return matrix;
}

std::vector<double> random_values(std::size_t count, std::uint64_t seed) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = uniform_vector<3>(random_bits(seed, RandomStream::kMeshJitter, 0, i))[0] - 0.5;
    return values;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

class EachMethod : public testing::TestWithParam<DefiniteMethod> {
protected:
    void SetUp() override {
        if (GetParam() == DefiniteMethod::kMultigrid && !has_multigrid()) GTEST_SKIP() << "a build without hypre";
    }
};
INSTANTIATE_TEST_SUITE_P(DefiniteSolver,
                         EachMethod,
                         testing::Values(DefiniteMethod::kFactors, DefiniteMethod::kMultigrid),
                         [](const auto& method) {
                             return method.param == DefiniteMethod::kFactors ? "Factors" : "Multigrid";
                         });

TEST_P(EachMethod, SolvesWithEachMatrixThatItWasGiven) {
    DefiniteSolver solver(GetParam());
    solver.analyze(laplacian_of_square(60, 1.0));
    EXPECT_EQ(solver.method(), GetParam());
    for (const double mass : {0.0, 0.3}) {
        const SymmetricMatrix matrix = laplacian_of_square(60, 2.0, mass);
        ASSERT_TRUE(solver.factorize(matrix));
        const std::vector<double> exact = random_values(matrix.size(), 1);
        std::vector<double> x(matrix.size());
        multiply(matrix, exact, x);
        solver.solve(x);
        for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], exact[i], 1e-9) << i;
    }
}

TEST_P(EachMethod, PreconditionsByASymmetricPositiveOperator) {
    const SymmetricMatrix matrix = laplacian_of_square(40, 1.0);
    DefiniteSolver solver(GetParam());
    solver.analyze(matrix);
    ASSERT_TRUE(solver.factorize(matrix));
    const std::vector<double> a = random_values(matrix.size(), 2), b = random_values(matrix.size(), 3);
    std::vector<double> of_a = a, of_b = b;
    solver.precondition(of_a);
    solver.precondition(of_b);
    EXPECT_NEAR(dot(of_a, b), dot(a, of_b), 1e-12 * std::sqrt(dot(of_a, of_a) * dot(b, b)));
    EXPECT_GT(dot(of_a, a), 0.0);
    // About the inverse: A^-1 A v is not far from v in the norm of A.
    std::vector<double> image(a.size()), error(a.size());
    multiply(matrix, a, image);
    const double size = dot(image, a);
    solver.precondition(image);
    for (std::size_t i = 0; i < a.size(); ++i) error[i] = image[i] - a[i];
    multiply(matrix, error, of_a);
    EXPECT_LT(dot(of_a, error), 0.3 * size);
}

TEST_P(EachMethod, KnowsAMatrixThatIsNotDefinite) {
    SymmetricMatrix matrix = laplacian_of_square(5, 1.0);
    matrix.diagonal(7) = -1.0;
    DefiniteSolver solver(GetParam());
    solver.analyze(matrix);
    EXPECT_FALSE(solver.factorize(matrix));
}

TEST(DefiniteSolver, TakesTheCheaperMethod) {
    EXPECT_EQ(cheaper_method(1'000, Refactored::kOften), DefiniteMethod::kFactors);
    EXPECT_EQ(cheaper_method(1'000'000, Refactored::kSeldom), DefiniteMethod::kFactors);
    EXPECT_EQ(cheaper_method(1'000'000, Refactored::kOften),
              has_multigrid() ? DefiniteMethod::kMultigrid : DefiniteMethod::kFactors);
}

}  // namespace
}  // namespace lamella::linalg
