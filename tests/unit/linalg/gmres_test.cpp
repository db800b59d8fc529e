#include "lamella/linalg/gmres.h"

#include <gtest/gtest.h>

namespace lamella::linalg {
namespace {

using Vector = std::vector<double>;

/// Row i: 2 + i/n on the diagonal, -1.5 to the left, 0.3 to the right. Not symmetric.
void skew_rows(const Vector& x, Vector& y) {
    const std::size_t n = x.size();
    y.assign(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        y[i] = (2.0 + static_cast<double>(i) / static_cast<double>(n)) * x[i];
        if (i > 0) y[i] -= 1.5 * x[i - 1];
        if (i + 1 < n) y[i] += 0.3 * x[i + 1];
    }
}

void leave(const Vector& v, Vector& z) { z = v; }

Vector wave(std::size_t n) {
    Vector x(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = std::sin(1.0 + 0.7 * static_cast<double>(i * i));
    return x;
}

double distance(const Vector& a, const Vector& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
}

double length(const Vector& a) { return distance(a, Vector(a.size(), 0.0)); }

TEST(Gmres, SolvesWhatIsNotSymmetricFromAnyStart) {
    const Vector exact = wave(50);
    Vector b;
    skew_rows(exact, b);
    for (const double start : {0.0, 3.0}) {
        Vector x(50, start), image;
        const GmresSolution done = gmres(skew_rows, leave, b, x, 1e-10, 50);
        EXPECT_LT(distance(x, exact), 1e-8);
        skew_rows(x, image);
        EXPECT_LE(done.residual, 1e-10);
        EXPECT_NEAR(distance(b, image) / length(b), done.residual, 1e-13);  // rounding: 50 products of size 1
    }
}

TEST(Gmres, NeedsAsManyIterationsAsThereAreEigenvalues) {
    const auto apply = [](const Vector& x, Vector& y) {
        y.resize(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) y[i] = (i % 3 == 0 ? 1.0 : i % 3 == 1 ? 2.0 : 5.0) * x[i];
    };
    const Vector b = wave(30);
    Vector x(30, 0.0);
    EXPECT_EQ(gmres(apply, leave, b, x, 1e-12, 30).iterations, 3);
}

TEST(Gmres, NeedsOneIterationWithThePerfectPreconditioner) {
    const auto apply = [](const Vector& x, Vector& y) {
        y.resize(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) y[i] = static_cast<double>(i + 1) * x[i];
    };
    const auto invert = [](const Vector& v, Vector& z) {
        z.resize(v.size());
        for (std::size_t i = 0; i < v.size(); ++i) z[i] = v[i] / static_cast<double>(i + 1);
    };
    const Vector b = wave(30);
    Vector x(30, 1.0);
    const GmresSolution done = gmres(apply, invert, b, x, 1e-12, 30);
    EXPECT_EQ(done.iterations, 1);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], b[i] / static_cast<double>(i + 1), 1e-14);
}

TEST(Gmres, TellsTheAnswerInTheVectorsThatTheOperatorSaw) {
    std::vector<Vector> seen;
    const auto apply = [&](const Vector& x, Vector& y) {
        seen.push_back(x);
        skew_rows(x, y);
    };
    const auto halve = [](const Vector& v, Vector& z) {
        z = v;
        for (double& value : z) value *= 0.5;
    };
    const Vector b = wave(40);
    Vector x(40, 0.5);
    const GmresSolution done = gmres(apply, halve, b, x, 1e-4, 40);
    ASSERT_EQ(seen.size(), done.weight.size() + 1);
    EXPECT_GT(done.iterations, 2);
    Vector sum = seen[0];
    for (std::size_t k = 0; k < done.weight.size(); ++k)
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += done.weight[k] * seen[k + 1][i];
    EXPECT_EQ(sum, x);
}

TEST(Gmres, StopsAtTheMostIterationsAndSaysWhatIsLeft) {
    const Vector b = wave(40);
    Vector x(40, 0.0), image;
    const GmresSolution done = gmres(skew_rows, leave, b, x, 1e-12, 3);
    EXPECT_EQ(done.iterations, 3);
    skew_rows(x, image);
    EXPECT_GT(done.residual, 1e-12);
    EXPECT_NEAR(distance(b, image) / length(b), done.residual, 1e-13);
}

TEST(Gmres, HasNothingToDoForZeroOrForTheAnswer) {
    int calls = 0;
    const auto apply = [&](const Vector& x, Vector& y) {
        ++calls;
        skew_rows(x, y);
    };
    Vector x = wave(10), b;
    EXPECT_EQ(gmres(apply, leave, Vector(10, 0.0), x, 1e-6, 10).iterations, 0);
    EXPECT_EQ(x, Vector(10, 0.0));
    EXPECT_EQ(calls, 0);
    x = wave(10);
    skew_rows(x, b);
    const GmresSolution done = gmres(apply, leave, b, x, 1e-6, 10);
    EXPECT_EQ(done.iterations, 0);
    EXPECT_EQ(done.residual, 0.0);
    EXPECT_EQ(calls, 1);
    EXPECT_EQ(x, wave(10));
}

}  // namespace
}  // namespace lamella::linalg
