// Fits of quadratics to particles, eight at once.

#include "lamella/solvers/melp/patch.h"

#include <gtest/gtest.h>

#include <vector>

namespace lamella::melp {
namespace {

constexpr double kReach = 3.2;

struct Cloud {
    std::vector<Vec3> position, normal;

    void add(const Vec3& x) {
        position.push_back(x);
        normal.push_back({{0.0, 0.0, 1.0}});
    }
    Neighbors neighbors() const {
        const std::vector<std::int32_t> region(position.size(), 0);
        return find_neighbors(position, normal, region, kReach).same;
    }
};

double surface(double x, double y) { return 0.3 - 0.1 * x + 0.2 * y + 0.01 * x * x - 0.02 * x * y + 0.03 * y * y; }

TEST(Patch, IsTheQuadraticThatParticlesLieOn) {
    Cloud cloud;
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 5; ++j) {
            const double x = i + 0.1 * (j % 3), y = j - 0.05 * i;
            cloud.add({{x, y, surface(x, y)}});
        }
    const Neighbors neighbors = cloud.neighbors();
    for (const std::size_t count : {1U, 8U, 11U, 45U}) {
        std::vector<Patch> patch(count);
        std::vector<FitRow> row(count);
        const std::size_t first = cloud.position.size() - count;
        fit_patches(cloud.position, cloud.normal, neighbors, {}, first, patch, row);
        for (std::size_t k = 0; k < count; ++k) {
            const Vec3& x = cloud.position[first + k];
            const Patch& p = patch[k];
            EXPECT_NEAR(p.c[0], 0.0, 1e-12);
            for (const auto& [dx, dy] : {std::array{1.0, 0.0}, std::array{0.0, 1.0}, std::array{-0.5, 0.7}}) {
                const double rise = surface(x[0] + dx, x[1] + dy) - x[2];
                EXPECT_NEAR(p.above({{x[0] + dx, x[1] + dy, x[2] + rise}}), 0.0, 1e-12);
            }
            double height = 0.0;  // of the patch over its particle, by the row
            for (std::size_t n = neighbors.begin(first + k); n < neighbors.end(first + k); ++n) {
                const Vec3 d = (cloud.position[neighbors.index[n]] - x) / kReach;
                const double lifted = 0.5 * d[0] + 0.1 * d[1] * d[1];  // a quadratic that is 0 at the particle
                const auto point = fit_point(dot(p.frame.e1, d), dot(p.frame.e2, d), d[2], squared_norm(d));
                for (std::size_t t = 0; t < Patch::kTerms; ++t)
                    height += point.weight * row[k][t] * point.term[t] * lifted;
            }
            EXPECT_NEAR(height, 0.0, 1e-12);
        }
    }
}

TEST(Patch, IsFlatWhereParticlesMakeNoQuadratic) {
    Cloud line, few;
    for (int i = 0; i < 12; ++i) line.add({{0.4 * i, 0.0, 0.1 * i * i}});
    for (int i = 0; i < 5; ++i) few.add({{1.0 * i, 0.3 * i * i, 0.1 * i}});
    for (const Cloud& cloud : {line, few}) {
        std::vector<Patch> patch(cloud.position.size());
        std::vector<FitRow> row(cloud.position.size());
        fit_patches(cloud.position, cloud.normal, cloud.neighbors(), {}, 0, patch, row);
        for (std::size_t k = 0; k < patch.size(); ++k)
            for (std::size_t t = 0; t < Patch::kTerms; ++t) {
                EXPECT_EQ(patch[k].c[t], 0.0);
                EXPECT_EQ(row[k][t], 0.0);
            }
    }
}

/// Particles of the same eight have longer and shorter rows.
TEST(Patch, DoesNotDependOnThoseItIsFittedWith) {
    Cloud cloud;
    for (int i = 0; i < 40; ++i) cloud.add({{0.05 * i * i, 0.7 * (i % 4), 0.01 * (i % 5)}});
    const Neighbors neighbors = cloud.neighbors();
    std::vector<Patch> all(cloud.position.size());
    fit_patches(cloud.position, cloud.normal, neighbors, {}, 0, all, {});
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::vector<Patch> one(1);
        fit_patches(cloud.position, cloud.normal, neighbors, {}, i, one, {});
        EXPECT_EQ(one[0].c, all[i].c);
    }
}

}  // namespace
}  // namespace lamella::melp
