#include "view/smooth_films.h"

#include <gtest/gtest.h>

#include "films.h"
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace lamella::app::view {
namespace {

/// A sphere of radius 1 around region 1: an octahedron, each face cut into n^2.
sim::Surface sphere(std::uint32_t n) {
    sim::Surface surface;
    std::map<std::array<long, 3>, std::uint32_t> known;
    const auto vertex = [&](long x, long y, long z) {  // on the octahedron, in units of 1 / n
        const auto [it, is_new] = known.try_emplace({x, y, z}, static_cast<std::uint32_t>(surface.position.size()));
        const Vec3 p{{double(x), double(y), double(z)}};
        if (is_new) surface.position.push_back(p / norm(p));
        return it->second;
    };
    for (const long sx : {-1L, 1L})
        for (const long sy : {-1L, 1L})
            for (const long sz : {-1L, 1L}) {
                const auto at = [&](long i, long j) { return vertex(sx * i, sy * j, sz * (long(n) - i - j)); };
                const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                    if (sx * sy * sz > 0)
                        surface.triangles.push_back({a, b, c});
                    else
                        surface.triangles.push_back({a, c, b});
                    surface.regions.push_back({1, 0});
                };
                for (long i = 0; i < long(n); ++i)
                    for (long j = 0; i + j < long(n); ++j) {
                        add(at(i, j), at(i + 1, j), at(i, j + 1));
                        if (i + j + 1 < long(n)) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                    }
            }
    return surface;
}

double farthest_from_sphere(const SmoothFilms& films) {
    double error = 0.0;
    for (const auto& triangle : films.triangles) {  // flat ones are wrong in their middle
        const Vec3 middle = (films.vertices[triangle[0]].position + films.vertices[triangle[1]].position +
                             films.vertices[triangle[2]].position) /
                            3.0;
        error = std::max(error, std::abs(norm(middle) - 1.0));
    }
    return error;
}

TEST(SmoothFilms, AreTheTrianglesAsTheyAreForOnePiece) {
    const sim::Surface surface = three_sheets(3).surface;
    const FilmParts parts = film_parts(surface);
    const SmoothFilms films = smooth_films(surface, parts, 1);
    EXPECT_EQ(films.triangles, parts.triangles);
    EXPECT_EQ(films.vertices.size(), parts.vertices.size());
    EXPECT_EQ(films.borders.size(), parts.borders.size());
}

TEST(SmoothFilms, AreRounderThanTheirTriangles) {
    const sim::Surface surface = sphere(4);
    const FilmParts parts = film_parts(surface);
    const double flat = farthest_from_sphere(smooth_films(surface, parts, 1));
    const double smooth = farthest_from_sphere(smooth_films(surface, parts, 4));
    EXPECT_GT(flat, 0.02);  // the octahedron's middle faces are 0.4 wide
    EXPECT_LT(smooth, 0.15 * flat);
}

TEST(SmoothFilms, HaveUnitNormalsIntoTheLargerRegion) {
    const sim::Surface surface = sphere(3);
    for (const SmoothFilms::Vertex& vertex : smooth_films(surface, film_parts(surface), 3).vertices) {
        EXPECT_NEAR(norm(vertex.normal), 1.0, 1e-14);
        EXPECT_LT(dot(vertex.normal, vertex.position), -0.9);  // region 1 is inside
    }
}

TEST(SmoothFilms, KeepMeetingOnABentBorder) {
    sim::Surface surface = with_outside(three_sheets(4).surface);
    for (Vec3& x : surface.position) x[0] += 0.3 * x[2] * x[2];
    const FilmParts parts = film_parts(surface);
    constexpr int kPieces = 3;
    const SmoothFilms films = smooth_films(surface, parts, kPieces);
    ASSERT_EQ(films.borders.size(), kPieces * parts.borders.size());
    for (const auto& segment : films.borders)
        for (const Vec3& end : segment) {
            std::set<std::array<std::int32_t, 2>> there;
            for (const SmoothFilms::Vertex& vertex : films.vertices)
                if (norm(vertex.position - end) < 1e-14) there.insert(vertex.regions);
            EXPECT_EQ(there.size(), 3u);
            // The cubic through the border's vertices is nearly the parabola; the chords leave it by 0.3 / 4 / 4^2.
            EXPECT_NEAR(end[0], 0.3 * end[2] * end[2], 1.5e-3);
        }
}

TEST(SmoothFilms, KeepStraightRimsAndTheirCorners) {
    const sim::Surface surface = with_outside(three_sheets(3).surface);
    for (const auto& segment : smooth_films(surface, film_parts(surface), 4).wires)
        for (const Vec3& end : segment) {
            const double radius = std::hypot(end[0], end[1]);
            EXPECT_NEAR(std::min({1.0 - radius, end[2], 1.0 - end[2]}), 0.0, 1e-14);
        }
}

TEST(SmoothFilms, FollowTheCurvedTrianglesOfTheFrame) {
    sim::Surface surface = three_sheets(1).surface;
    sim::Field nodes{sim::kCurvedNodes, "m", 18, false, {}};
    const auto lifted = [](Vec3 x) { return x + Vec3{{0.0, 0.0, 0.1 * x[0] * x[1]}}; };  // the same for all that meet
    for (Vec3& x : surface.position) x = lifted(x);
    const sim::Surface flat = three_sheets(1).surface;
    for (const auto& t : flat.triangles) {
        for (std::size_t k = 0; k < 3; ++k)
            for (const double x : lifted(flat.position[t[k]]).v) nodes.values.push_back(x);
        for (std::size_t k = 0; k < 3; ++k)
            for (const double x : lifted(0.5 * (flat.position[t[k]] + flat.position[t[(k + 1) % 3]])).v)
                nodes.values.push_back(x);
    }
    surface.face_fields = {nodes};
    const SmoothFilms films = smooth_films(surface, film_parts(surface), 4);
    // A quadratic map of flat triangles: the quadratic triangles hold it exactly.
    for (const SmoothFilms::Vertex& vertex : films.vertices) {
        Vec3 x;
        for (std::size_t k = 0; k < 3; ++k) x += vertex.weights[k] * flat.position[vertex.sources[k]];
        EXPECT_LT(norm(vertex.position - lifted(x)), 1e-14);
    }
}

}  // namespace
}  // namespace lamella::app::view
