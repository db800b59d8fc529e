#include "lamella/solvers/vortex_particle/particles.h"

#include "lamella/solvers/vortex_particle/trace.h"
#include "lamella/solvers/vortex_particle/transfer.h"

#include <gtest/gtest.h>

#include "surfaces.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(Particles, LieInTheirTrianglesAndSortWithoutLoss) {
    const Surface s = surface_of(mesh::spheres({{Vec3{}, 1.0}}, 0.3));
    Particles particles = spread_particles(s, 7, 3);
    EXPECT_NEAR(sum(particles.area), s.total_area, 1e-12);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        particles.circulation[p] = static_cast<double>(p);
        particles.triangle[p] = static_cast<std::uint32_t>((p * 7919) % s.triangles());
        EXPECT_GE(*std::min_element(particles.place[p].begin(), particles.place[p].end()), 0.0);
    }
    const Bins bins = sort_by_triangle(particles, s.triangles());
    EXPECT_TRUE(std::is_sorted(particles.triangle.begin(), particles.triangle.end()));
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (std::size_t p = bins[t]; p < bins[t + 1]; ++p) {
            EXPECT_EQ(particles.triangle[p], t);
            if (p == bins[t]) continue;
            EXPECT_LT(particles.circulation[p - 1], particles.circulation[p]);  // in order of before
        }
}

TEST(Particles, FillEmptyTrianglesWithoutMakingOrLosingAnything) {
    const Surface s = surface_of(mesh::disk({}, {{0, 0, 1}}, 1.0, 0.2));
    Particles particles = spread_particles(s, 2, 3);
    particles.circulation = random_values(8, particles.size());
    particles.volume = random_values(9, particles.size());
    for (std::uint32_t& t : particles.triangle)
        if (t % 5 < 2) t = 0;  // two fifths of the triangles are empty, some beside each other
    Bins bins = sort_by_triangle(particles, s.triangles());
    const double circulation = sum(particles.circulation), volume = sum(particles.volume), area = sum(particles.area);
    fill_empty_triangles(s, particles, bins);
    for (std::size_t t = 0; t < s.triangles(); ++t) EXPECT_LT(bins[t], bins[t + 1]);
    EXPECT_TRUE(std::is_sorted(particles.triangle.begin(), particles.triangle.end()));
    EXPECT_NEAR(sum(particles.circulation), circulation, 1e-12);
    EXPECT_NEAR(sum(particles.volume), volume, 1e-12);
    EXPECT_NEAR(sum(particles.area), area, 1e-12);
}

TEST(Transfer, PutsOnTheMeshWhatParticlesHaveAndConstantsStayConstant) {
    for (const auto& [name, s, walls] : surfaces_of_every_kind())
        for (const Reach reach : {Reach::kHat, Reach::kKernel}) {
            const Transfer transfer(s, reach, 1.5 * s.longest_edge);
            Particles particles = spread_particles(s, 10, 5);
            particles.circulation = random_values(8, particles.size());
            particles.volume = particles.area;
            for (double& v : particles.volume) v *= 4e-7;
            const Bins bins = sort_by_triangle(particles, s.triangles());
            const Deposit on = transfer.deposit(s, particles, bins);
            EXPECT_NEAR(sum(on.circulation), sum(particles.circulation), 1e-11) << name;
            EXPECT_NEAR(sum(on.area), s.total_area, 1e-12 * s.total_area) << name;
            for (std::size_t v = 0; v < s.vertices(); ++v) EXPECT_NEAR(on.volume[v] / on.area[v], 4e-7, 1e-20) << name;
            const std::vector<double> same = transfer.gather(s, particles, std::vector<double>(s.vertices(), 2.5));
            for (const double value : same) EXPECT_NEAR(value, 2.5, 1e-14) << name;
            const std::vector<double> alone = transfer.deposit(s, particles, bins, particles.circulation);
            for (std::size_t v = 0; v < s.vertices(); ++v) EXPECT_NEAR(alone[v], on.circulation[v], 1e-12) << name;
        }
}

TEST(Walk, GoesStraightOverEdgesAndSlidesAlongWalls) {
    const Surface s = surface_of(mesh::rectangle({}, {{1, 0, 0}}, {{0, 1, 0}}, 0.1));
    Particles particles = spread_particles(s, 3, 1);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const Vec3 way{{0.6 * random_number(9, p), 0.6 * random_number(10, p), 0.0}};
        Spot spot{particles.triangle[p], particles.place[p]};
        const Vec3 from = s.point(spot.triangle, spot.place);
        walk(s, spot, way);
        const Vec3 to = s.point(spot.triangle, spot.place);
        // In a rectangle what sticks out of a wall is cut off, which leaves the other component alone.
        EXPECT_NEAR(to[0], std::clamp(from[0] + way[0], 0.0, 1.0), 1e-12);
        EXPECT_NEAR(to[1], std::clamp(from[1] + way[1], 0.0, 1.0), 1e-12);
    }
}

TEST(Walk, FollowsTheShortestWayOfASphere) {
    // Over flat triangles a straight way is one of the polyhedron: it leaves the great circle by the square of edges.
    std::vector<double> error;
    for (const double edge : {0.2, 0.1, 0.05}) {
        const Surface s = surface_of(mesh::spheres({{Vec3{}, 1.0}}, edge));
        double worst = 0.0;
        for (std::uint32_t t = 0; t < s.triangles(); t += 7) {
            Spot spot{t, {0.2, 0.3, 0.5}};
            const Vec3 from = s.point(t, spot.place), start = from / norm(from);
            Vec3 way = cross(s.normal[t], Vec3{{0.3, 0.5, 0.8}});
            way *= 0.5 / norm(way);
            walk(s, spot, way);
            const Vec3 to = s.point(spot.triangle, spot.place);
            const Vec3 exact = std::cos(0.5) * start + std::sin(0.5) * (way / norm(way));
            worst = std::max(worst, norm(to / norm(to) - exact));
        }
        error.push_back(worst);
    }
    EXPECT_LT(error[2], 0.01);
    EXPECT_GT(std::log2(error[0] / error[2]), 1.4);  // over two halvings: at least order 0.7 in the worst triangle
}

TEST(Trace, IsOfFourthOrderInARigidRotation) {
    // Linear velocity is exact between vertices: what is left is the error of the time step, 2 pi in n steps.
    const Surface s = surface_of(mesh::disk({}, {{0, 0, 1}}, 1.0, 0.1));
    std::vector<Vec3> velocity(s.vertices());
    for (std::size_t v = 0; v < s.vertices(); ++v) velocity[v] = cross({{0, 0, 1}}, s.position[v]);
    std::vector<double> error;
    for (const int steps : {20, 40}) {
        Particles particles = spread_particles(s, 1, 2);
        std::vector<Vec3> start;
        for (std::size_t p = 0; p < particles.size(); ++p)
            start.push_back(s.point(particles.triangle[p], particles.place[p]));
        for (int k = 0; k < steps; ++k) trace(s, velocity, 2.0 * 3.14159265358979323846 / steps, particles);
        double worst = 0.0;
        for (std::size_t p = 0; p < particles.size(); ++p)
            if (norm(start[p]) < 0.8)
                worst = std::max(worst, norm(s.point(particles.triangle[p], particles.place[p]) - start[p]));
        error.push_back(worst);
    }
    EXPECT_GT(std::log2(error[0] / error[1]), 3.7);
}

TEST(Trace, TurnsVelocitiesAlongWithTheFilm) {
    const Surface s = surface_of(mesh::spheres({{Vec3{}, 1.0}}, 0.1));
    std::vector<Vec3> velocity(s.vertices());
    for (std::size_t v = 0; v < s.vertices(); ++v) velocity[v] = cross({{0, 0, 1}}, s.position[v]);
    Particles particles = spread_particles(s, 1, 2);
    for (std::size_t p = 0; p < particles.size(); ++p)
        particles.velocity[p] = cross(s.normal[particles.triangle[p]], {{1, 2, 3}});
    const std::vector<Vec3> before = particles.velocity;
    for (int k = 0; k < 10; ++k) trace(s, velocity, 0.1, particles);
    for (std::size_t p = 0; p < particles.size(); ++p) {
        EXPECT_NEAR(norm(particles.velocity[p]), norm(before[p]), 1e-12);
        EXPECT_NEAR(dot(particles.velocity[p], s.normal[particles.triangle[p]]), 0.0, 1e-12);
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
