// The matrix of the implicit motion along the normals.

#include "lamella/solvers/melp/normal_matrix.h"

#include <gtest/gtest.h>

#include "joined.h"
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace lamella::melp {
namespace {

constexpr double kShapeDamping = 2e5;  // [1/s]: twenty times the masses in a step of 0.1 ms

void matrix_of_a_pair(const std::function<void(NormalMatrix&, const NormalProblem&)>& use) {
    const Joined pair;
    pair.problem(
        [&](const NormalProblem& problem) {
            const Pairs pairs = pair_strengths(problem);
            const std::vector<Spring> walls(problem.coarse.size());
            const Flight flight(problem.geometry, problem.coarse, problem.mass, problem.gas.size());
            const Inertia inertia(problem, flight, walls);
            const FoldSprings folds(problem, pairs);
            FilmStiffness films(problem, pairs, folds);
            const GasStiffness gas(problem);
            NormalMatrix matrix(problem, flight, inertia, gas, films);
            use(matrix, problem);
        },
        kShapeDamping);
}

std::vector<double> waves(std::size_t count, double phase) {
    std::vector<double> v;
    for (std::size_t i = 0; i < count; ++i) v.push_back(std::sin(phase + 12.9898 * static_cast<double>(i)));
    return v;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

TEST(NormalMatrix, IsSymmetricAndPositiveAndSoIsItsPreconditioner) {
    matrix_of_a_pair([](NormalMatrix& matrix, const NormalProblem& problem) {
        const std::vector<double> u = waves(problem.coarse.size(), 1.0), v = waves(problem.coarse.size(), 2.0);
        std::vector<double> of_u, of_v;
        matrix.apply(u, of_u);
        matrix.apply(v, of_v);
        EXPECT_NEAR(product(u, of_v), product(v, of_u), 1e-6 * product(u, of_u));  // single precision
        EXPECT_GT(product(u, of_u), 0.0);
        matrix.precondition(u, of_u);
        matrix.precondition(v, of_v);
        EXPECT_NEAR(product(u, of_v), product(v, of_u), 1e-12 * product(u, of_u));
        EXPECT_GT(product(u, of_u), 0.0);
    });
}

/// Two bubbles that fly as one strain no film, breathe not and have no shape that is damped.
TEST(NormalMatrix, LetsBubblesFlyWithNothingButTheirMass) {
    matrix_of_a_pair([](NormalMatrix& matrix, const NormalProblem& problem) {
        const Vec3 velocity{{0.3, -0.5, 0.4}};
        std::vector<double> flight, momentum;
        for (const Vec3& normal : problem.geometry.normal) flight.push_back(dot(velocity, normal));
        matrix.apply(flight, momentum);
        const double mass = product(flight, flight);  // each particle has 1
        EXPECT_NEAR(product(flight, momentum), mass, 0.02 * mass);
        std::vector<double> shape = waves(flight.size(), 1.0), damped;
        matrix.apply(shape, damped);
        EXPECT_GT(product(shape, damped), 15.0 * product(shape, shape));
    });
}

/// Steps as foams take them, with springs of 144 tensions at their folds: 49 iterations with the diagonal and the gases
/// alone.
TEST(NormalMatrix, TakesFewIterationsInAPackedFoam) {
    const auto solver = started(
        "seed = 3\n[material]\nsurface_tension = 0.025\nthickness = 5e-7\n"
        "[foam]\ncount = 12\nvolume = 4.18879e-6\n[resolution]\nedge_length = 0.0016\n"
        "[melp]\nfine_ratio = 0\ndamping = 12.0\nshape_damping = 20000.0\nsteps_per_period = 0\nlargest_step = 1e-3\n"
        "cfl = 1.0\nsolver_tolerance = 1e-6\n");
    std::int64_t iterations = 0;
    constexpr int kSteps = 4;
    for (int step = 0; step < kSteps; ++step) iterations += solver->advance(1e9).iterations;
    EXPECT_GT(iterations, 0);
    EXPECT_LT(iterations, 35 * kSteps);
}

}  // namespace
}  // namespace lamella::melp
