#include "lamella/spatial/vortex_sum.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace lamella::spatial {
namespace {

constexpr VortexKernel kKernels[] = {VortexKernel::kPlummer, VortexKernel::kK2, VortexKernel::kK3};
using Method = VortexSumOptions::Method;
using Precision = VortexSumOptions::Precision;

struct Elements {
    std::vector<Vec3> centers, strengths;
};

Vec3 random_vector(std::size_t stream, std::size_t i) {
    return uniform_vector<3>(random_bits(7, RandomStream::kMeshJitter, stream, i)) - Vec3{{0.5, 0.5, 0.5}};
}

Elements random_elements(std::size_t count) {
    Elements e;
    for (std::size_t i = 0; i < count; ++i) {
        e.centers.push_back(random_vector(0, i));
        e.strengths.push_back(random_vector(1, i));
    }
    return e;
}

double velocity_kernel(VortexKernel kernel, double r, double delta) {
    const double q = r * r + delta * delta, d2 = delta * delta;
    if (kernel == VortexKernel::kPlummer) return std::pow(q, -1.5);
    if (kernel == VortexKernel::kK2) return (r * r + 4.0 * d2) * std::pow(q, -2.5);
    return std::pow(q, -1.5) + 1.5 * d2 * std::pow(q, -2.5) + 7.5 * d2 * d2 * std::pow(q, -3.5);
}

double potential_kernel(VortexKernel kernel, double r, double delta) {
    const double q = r * r + delta * delta, d2 = delta * delta;
    if (kernel == VortexKernel::kPlummer) return std::pow(q, -0.5);
    if (kernel == VortexKernel::kK2) return std::pow(q, -0.5) + d2 * std::pow(q, -1.5);
    return std::pow(q, -0.5) + 0.5 * d2 * std::pow(q, -1.5) + 1.5 * d2 * d2 * std::pow(q, -2.5);
}

/// The two sums as the header states them, pair by pair.
VortexField naive_sum(std::span<const Vec3> targets, const Elements& e, VortexKernel kernel, double delta) {
    VortexField field;
    for (const Vec3& x : targets) {
        Vec3 u, a;
        for (std::size_t g = 0; g < e.centers.size(); ++g) {
            const Vec3 r = x - e.centers[g];
            u += velocity_kernel(kernel, norm(r), delta) * cross(e.strengths[g], r);
            a += potential_kernel(kernel, norm(r), delta) * e.strengths[g];
        }
        field.velocity.push_back(u / (4.0 * std::numbers::pi));
        field.potential.push_back(a / (4.0 * std::numbers::pi));
    }
    return field;
}

/// Largest difference over the largest value.
double relative_error(const std::vector<Vec3>& found, const std::vector<Vec3>& expected) {
    double error = 0.0, largest = 0.0;
    EXPECT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        error = std::max(error, norm(found[i] - expected[i]));
        largest = std::max(largest, norm(expected[i]));
    }
    return error / largest;
}

VortexSumOptions direct(VortexKernel kernel, double delta, Precision precision = Precision::kDouble) {
    return {.kernel = kernel, .delta = delta, .method = Method::kDirect, .precision = precision};
}

TEST(VortexKernel, IsMinusTheSlopeOfThePotentialOverTheDistance) {
    for (const VortexKernel kernel : kKernels)
        for (const double r : {0.05, 0.3, 1.0, 4.0}) {
            const double h = 1e-4 * (r + 0.3);
            const double slope =
                (potential_kernel(kernel, r + h, 0.3) - potential_kernel(kernel, r - h, 0.3)) / (2.0 * h);
            // step^2 of the central difference, 1e-8, times derivatives that grow like the kernel itself
            EXPECT_NEAR(-slope / r, velocity_kernel(kernel, r, 0.3), 1e-6 * velocity_kernel(kernel, r, 0.3));
        }
}

TEST(VortexSum, DirectEqualsTheDoubleLoop) {
    // Sizes around the lengths of vectors and blocks; rounding of some hundred terms.
    for (const std::size_t count : {1U, 2U, 7U, 17U, 256U, 600U}) {
        const Elements e = random_elements(count);
        std::vector<Vec3> targets = e.centers;
        for (std::size_t i = 0; i < 5; ++i) targets.push_back(2.0 * random_vector(2, i));
        for (const VortexKernel kernel : kKernels) {
            const VortexField expected = naive_sum(targets, e, kernel, 0.02);
            const VortexField found = vortex_sum(targets, e.centers, e.strengths, direct(kernel, 0.02), true);
            EXPECT_LT(relative_error(found.velocity, expected.velocity), 1e-13);
            EXPECT_LT(relative_error(found.potential, expected.potential), 1e-13);
            const VortexField alone = vortex_sum(targets, e.centers, e.strengths, direct(kernel, 0.02), false);
            EXPECT_EQ(alone.velocity, found.velocity);
            EXPECT_TRUE(alone.potential.empty());
        }
    }
}

TEST(VortexSum, SinglePrecisionIsGoodToAFewMillionths) {
    const Elements e = random_elements(2000);
    for (const VortexKernel kernel : kKernels) {
        const VortexField exact = vortex_sum(e.centers, e.centers, e.strengths, direct(kernel, 0.02), true);
        const VortexField found =
            vortex_sum(e.centers, e.centers, e.strengths, direct(kernel, 0.02, Precision::kSingle), true);
        // half an ulp of a coordinate is 3e-8 * 0.5, a hundredth of a millionth of delta per 0.02
        EXPECT_LT(relative_error(found.velocity, exact.velocity), 3e-6);
        EXPECT_LT(relative_error(found.potential, exact.potential), 3e-6);
        EXPECT_NE(found.velocity, exact.velocity);
    }
}

TEST(VortexSum, VelocityIsTheCurlOfThePotential) {
    const Elements e = random_elements(40);
    const double h = 1e-4;
    for (const VortexKernel kernel : kKernels) {
        const Vec3 x{{0.1, -0.2, 0.05}};
        std::vector<Vec3> targets{x};
        for (std::size_t k = 0; k < 3; ++k)
            for (const double side : {-h, h}) {
                targets.push_back(x);
                targets.back()[k] += side;
            }
        const VortexField field = vortex_sum(targets, e.centers, e.strengths, direct(kernel, 0.2), true);
        const auto derivative = [&](std::size_t k) {
            return (field.potential[2 + 2 * k] - field.potential[1 + 2 * k]) / (2.0 * h);
        };
        const Vec3 dx = derivative(0), dy = derivative(1), dz = derivative(2);
        const Vec3 curl{{dy[2] - dz[1], dz[0] - dx[2], dx[1] - dy[0]}};
        EXPECT_LT(norm(curl - field.velocity[0]), 1e-5 * norm(field.velocity[0]));  // (h / delta)^2 = 2.5e-7
    }
}

TEST(VortexSum, IsEmptyWithoutTargetsAndZeroWithoutElements) {
    const std::vector<Vec3> none, one{{{1.0, 2.0, 3.0}}};
    EXPECT_TRUE(vortex_sum(none, one, one, direct(VortexKernel::kK3, 0.1), true).velocity.empty());
    const VortexField still = vortex_sum(one, none, none, direct(VortexKernel::kK3, 0.1), true);
    EXPECT_EQ(still.velocity, std::vector<Vec3>(1));
    EXPECT_EQ(still.potential, std::vector<Vec3>(1));
    EXPECT_EQ(vortex_sum(one, one, std::vector<Vec3>(1), direct(VortexKernel::kK3, 0.1), true).velocity,
              std::vector<Vec3>(1));
}

TEST(VortexSum, OneElementSeesItsOwnPotentialAndNoVelocity) {
    const std::vector<Vec3> center{{{1.0, 2.0, 3.0}}}, strength{{{0.0, 3.0, 0.0}}};
    const VortexField field = vortex_sum(center, center, strength, direct(VortexKernel::kK3, 0.5), true);
    EXPECT_EQ(norm(field.velocity[0]), 0.0);
    EXPECT_NEAR(field.potential[0][1], 3.0 * 3.0 / 0.5 / (4.0 * std::numbers::pi), 1e-14);  // psi(0) = 3 / delta
}

TEST(VortexSum, RefusesWhatItCannotSum) {
    const std::vector<Vec3> one(1), two(2), far{{}, {{1.0, 0.0, 0.0}}};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(vortex_sum(one, one, one, direct(VortexKernel::kK3, 0.0), true), InputError);
    EXPECT_THROW(vortex_sum(one, one, one, direct(VortexKernel::kK3, nan), true), InputError);
    EXPECT_THROW(vortex_sum(one, one, two, direct(VortexKernel::kK3, 0.1), true), InputError);
    EXPECT_THROW(vortex_sum(std::vector<Vec3>{{{nan, 0.0, 0.0}}}, one, one, direct(VortexKernel::kK3, 0.1), true),
                 InputError);
    EXPECT_THROW(vortex_sum(far, one, one, direct(VortexKernel::kK3, 1e-16), true), InputError);
    VortexSumOptions loose = direct(VortexKernel::kK3, 0.1);
    loose.tolerance = 1.0;
    EXPECT_THROW(vortex_sum(one, one, one, loose, true), InputError);
}

TEST(VortexSum, GivesTheSameBitsOnOneAndTwoThreads) {
    const Elements e = random_elements(3000);
    for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
        const auto sum = [&](int threads) {
            const ThreadLimit limit(threads);
            return vortex_sum(e.centers, e.centers, e.strengths, direct(VortexKernel::kK3, 0.02, precision), true);
        };
        const VortexField one = sum(1), two = sum(2);
        EXPECT_EQ(one.velocity, two.velocity);
        EXPECT_EQ(one.potential, two.potential);
    }
}

}  // namespace
}  // namespace lamella::spatial
