// Springs that hold particles of joined bubbles to their film.

#include "lamella/solvers/melp/fold_springs.h"

#include <gtest/gtest.h>

#include "joined.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace lamella::melp {
namespace {

/// What `use` makes of the springs between the particles of a pair as they are now.
template <class Use>
void springs(const Joined& pair, Use&& use) {
    pair.problem(
        [&](const NormalProblem& problem) { use(FoldSprings(problem, pair_strengths(problem)), problem.geometry); });
}

TEST(FoldSprings, PullASingleParticleBackAndItsNeighborsTheOtherWay) {
    Joined pair;
    const std::size_t i = pair.on_partition;
    const double height = 1e-4;
    const auto resultant = [&](const FoldSprings& folds, const Geometry& geometry) {
        Vec3 all;
        for (std::size_t j = 0; j < pair.coarse.size(); ++j) all += folds.force(j) * geometry.normal[j];
        return all;
    };
    double before = 0.0;
    Vec3 all_before;
    springs(pair, [&](const FoldSprings& folds, const Geometry& geometry) {
        before = folds.force(i);
        all_before = resultant(folds, geometry);
    });
    pair.coarse.position[i] += height * pair.solver().geometry().normal[i];
    springs(pair, [&](const FoldSprings& folds, const Geometry& geometry) {
        const Neighbors& same = geometry.neighbors.same;
        const double reach = same.kernel.support_radius, own = folds.force(i) - before;
        const double k = FoldSprings::kStiffness * 2.0 * kTension * geometry.area[i] / (reach * reach);
        EXPECT_LT(own, -0.3 * k * height);
        EXPECT_GT(own, -1.5 * k * height);
        EXPECT_LT(norm(resultant(folds, geometry) - all_before), 0.05 * std::abs(own));
    });
}

TEST(FoldSprings, HaveASymmetricPositiveMatrixAndNoneWhereNoOtherBubbleIs) {
    const Joined pair;
    const std::size_t count = pair.coarse.size();
    std::vector<double> u(count), v(count);
    for (std::size_t i = 0; i < count; ++i) {
        u[i] = std::sin(1.0 + 12.9898 * static_cast<double>(i));
        v[i] = std::sin(2.0 + 78.233 * static_cast<double>(i));
    }
    springs(pair, [&](const FoldSprings& folds, const Geometry& geometry) {
        const Neighbors& same = geometry.neighbors.same;
        const auto strain = [&](const std::vector<double>& w) {
            std::vector<double> result(count, 0.0);
            for (std::size_t i = 0; i < count; ++i)
                if (folds.strained(i)) result[i] = folds.strain(i, w[i], sum_of_products(same, folds.heights(), w, i));
            return result;
        };
        const std::vector<double> of_u = strain(u), of_v = strain(v);
        double uv = 0.0, vu = 0.0, uu = 0.0, alone = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            uv += u[i] * folds.hold(i, of_v);
            vu += v[i] * folds.hold(i, of_u);
            uu += u[i] * folds.hold(i, of_u);
            const Neighbors& other = geometry.neighbors.other;
            if (other.begin(i) == other.end(i)) alone = std::max(alone, std::abs(of_u[i]));
        }
        EXPECT_NEAR(uv, vu, 1e-6 * uu);
        EXPECT_GT(uu, 0.0);
        EXPECT_EQ(alone, 0.0);
    });
}

/// Spikes that were taken back after each step kept borders moving, at 2 to 27 cm/s.
TEST(FoldSprings, LetJoinedBubblesComeToRest) {
    const auto solver = joined_until(0.025);
    std::printf("fastest %.4f m/s\n", scalar(*solver, "max_velocity"));
    EXPECT_LT(scalar(*solver, "max_velocity"), 0.005);
}

}  // namespace
}  // namespace lamella::melp
