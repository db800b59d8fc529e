#include "lamella/solvers/vortex_particle/leaves.h"

#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/solvers/vortex_particle/exchange.h"
#include "lamella/solvers/vortex_particle/rebin.h"

#include <gtest/gtest.h>

#include "surfaces.h"
#include <algorithm>
#include <array>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

TEST(Leaves, CloseAroundEachBubble) {
    const mesh::FoamMesh films = mesh::double_bubble(mesh::double_bubble_of_volumes(1e-3, 5e-4), 0.03);
    const Surface s = surface_of(films);
    EXPECT_EQ(s.components, 2U);
    EXPECT_TRUE(s.loops.empty());  // no walls: each leaf goes on over the triple line
    double volume = 0.0, film = 0.0;
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const auto& [a, b, c] = s.corner[t];
        if (s.region[t] == 1) volume += dot(s.position[a], cross(s.position[b], s.position[c])) / 6.0;
        film += s.share[t] * s.area[t];
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_NE(s.neighbor[t][k], kNoNeighbor);
            EXPECT_EQ(s.region[static_cast<std::size_t>(s.neighbor[t][k])], s.region[t]);
        }
        if (s.partner[t] != kNoPartner) {
            EXPECT_EQ(s.partner[s.partner[t]], t);
        }
        EXPECT_EQ(s.partner[t] != kNoPartner, s.share[t] == 0.5);
    }
    EXPECT_GT(volume, 0.0);  // it is seen from outside
    double area = 0.0;
    for (const mesh::Face& face : films.faces) {
        const auto& [a, b, c] = face.vertices;
        area += 0.5 * norm(cross(films.position[b] - films.position[a], films.position[c] - films.position[a]));
    }
    EXPECT_NEAR(film / area, 1.0, 1e-12);
}

TEST(LeafExchange, GivesToTheLeafWithLessAndLosesNothing) {
    const Surface s = surface_of(mesh::double_bubble(mesh::double_bubble_of_volumes(1e-3, 1e-3), 0.03));
    Particles particles = spread_particles(s, 5, 1);
    const Bins bins = sort_by_triangle(particles, s.triangles());
    for (std::size_t p = 0; p < particles.size(); ++p) {
        particles.volume[p] = particles.area[p];
        particles.amount[p] = particles.area[p] * (s.region[particles.triangle[p]] == 1 ? 2.0 : 1.0);
    }
    const auto sum = [&](const std::vector<double>& column, bool shared, std::uint32_t region) {
        double total = 0.0;
        for (std::size_t p = 0; p < particles.size(); ++p) {
            const std::uint32_t t = particles.triangle[p];
            if ((s.partner[t] != kNoPartner) == shared && s.region[t] == region) total += column[p];
        }
        return total;
    };
    const double outer = sum(particles.amount, false, 1), mine = sum(particles.amount, true, 1);
    const double other = sum(particles.amount, true, 2), liquid = sum(particles.volume, true, 2);
    exchange_between_leaves(s, bins, 0.2, particles);
    const double given = -std::expm1(-0.1);  // half as much is there: half the rate
    EXPECT_EQ(sum(particles.amount, false, 1), outer);
    EXPECT_NEAR(sum(particles.amount, true, 1) / mine, 1.0 - given, 1e-12);
    EXPECT_NEAR(sum(particles.amount, true, 2) / (other + given * mine), 1.0, 1e-12);
    EXPECT_NEAR(sum(particles.volume, true, 2) / liquid, 1.0 + given, 1e-12);
}

TEST(MergeCrowds, KeepsAllThatParticlesHave) {
    const Surface s = surface_of(mesh::spheres({{Vec3{}, 1.0}}, 0.5));
    Particles particles = spread_particles(s, 12, 1);
    Bins bins = sort_by_triangle(particles, s.triangles());
    for (double& volume : particles.volume) volume = 1.0;
    particles.circulation = random_values(3, particles.size());
    const double area = std::accumulate(particles.area.begin(), particles.area.end(), 0.0);
    const double volume = std::accumulate(particles.volume.begin(), particles.volume.end(), 0.0);
    const double circulation = std::accumulate(particles.circulation.begin(), particles.circulation.end(), 0.0);
    merge_crowds(s, 8, particles, bins);
    for (std::size_t t = 0; t < s.triangles(); ++t) EXPECT_EQ(bins[t + 1] - bins[t], 8U);
    EXPECT_NEAR(std::accumulate(particles.area.begin(), particles.area.end(), 0.0) / area, 1.0, 1e-12);
    EXPECT_NEAR(std::accumulate(particles.volume.begin(), particles.volume.end(), 0.0), volume, 1e-12 * volume);
    EXPECT_NEAR(std::accumulate(particles.circulation.begin(), particles.circulation.end(), 0.0), circulation,
                1e-12 * volume);
    for (const auto& place : particles.place) EXPECT_NEAR(place[0] + place[1] + place[2], 1.0, 1e-12);
}

/// Work that grew with the cube of the crowd would take hours here.
TEST(MergeCrowds, TakesCrowdsOfManyThousands) {
    const Surface s = surface_of(mesh::spheres({{Vec3{}, 1.0}}, 0.1));
    Particles particles = spread_particles(s, 12, 1);
    for (double& volume : particles.volume) volume = 1.0;
    std::fill(particles.triangle.begin(), particles.triangle.end(), 7U);
    const auto count = static_cast<double>(particles.size());
    const auto center = [&] {
        std::array<double, 3> sum{};
        for (std::size_t p = 0; p < particles.size(); ++p)
            for (std::size_t k = 0; k < 3; ++k) sum[k] += particles.volume[p] * particles.place[p][k] / count;
        return sum;
    };
    const std::array<double, 3> before = center();
    Bins bins = sort_by_triangle(particles, s.triangles());
    ASSERT_GT(particles.size(), 20000U);
    merge_crowds(s, 40, particles, bins);
    EXPECT_EQ(particles.size(), 40U);
    EXPECT_NEAR(std::accumulate(particles.volume.begin(), particles.volume.end(), 0.0), count, 1e-9 * count);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(center()[k], before[k], 1e-12);
    // Neighbors have merged: none has become a large share of all.
    EXPECT_LT(*std::max_element(particles.volume.begin(), particles.volume.end()), 0.1 * count);
}

}  // namespace
}  // namespace lamella::vortex_particle
