#include "lamella/solvers/melp/film_ends.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include <algorithm>
#include <map>
#include <numbers>

namespace lamella::melp {
namespace {

double area_of(const sim::Surface& s) {
    double area = 0.0;
    for (const auto& [a, b, c] : s.triangles)
        area += 0.5 * norm(cross(s.position[b] - s.position[a], s.position[c] - s.position[a]));
    return area;
}

/// Ends of edges of one triangle only.
std::vector<std::uint32_t> outline(const sim::Surface& s) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& t : s.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    std::vector<std::uint32_t> ends;
    for (const auto& [edge, count] : uses)
        if (count == 1) ends.insert(ends.end(), {edge.first, edge.second});
    return ends;
}

sim::Frame film(const std::string& tables) {
    auto solver = solver_of("[material]\nthickness = 5e-7\n" + tables);
    solver->start({});
    return solver->frame();
}

TEST(FilmEnds, ReachTheFourWiresOfAFrameAndItsCorners) {
    const sim::Surface s =
        film("[[film]]\nshape = \"rectangle\"\nu = [0.08, 0, 0]\nv = [0, 0, 0.06]\n[resolution]\nedge_length = 0.004\n")
            .surface;
    const sim::Field* on_wire = s.find_of_vertices("on_wire");
    ASSERT_NE(on_wire, nullptr);
    for (const std::uint32_t v : outline(s)) {
        EXPECT_EQ(on_wire->values[v], 1.0);
        const double x = s.position[v][0], z = s.position[v][2];
        EXPECT_NEAR(std::min({x, 0.08 - x, z, 0.06 - z}), 0.0, 1e-12);
    }
    EXPECT_NEAR(area_of(s) / (0.08 * 0.06), 1.0, 1e-12);  // the corners are there
    for (const sim::Field& field : s.vertex_fields)
        EXPECT_EQ(field.values.size(), s.position.size() * static_cast<std::size_t>(field.components)) << field.name;
}

TEST(FilmEnds, ReachARing) {
    const sim::Surface s =
        film("[[film]]\nshape = \"disk\"\nradius = 0.05\n[resolution]\nedge_length = 0.0025\n").surface;
    for (const std::uint32_t v : outline(s)) EXPECT_NEAR(norm(s.position[v]), 0.05, 1e-12);
    EXPECT_NEAR(area_of(s) / (std::numbers::pi * 0.05 * 0.05), 1.0, 3e-3);  // a polygon of 130 corners
}

TEST(FilmEnds, AreNoneAtAHole) {
    CoarseParticles coarse;  // two triangles between wires at x = 0 and far away
    coarse.position = {{{0.1, 0.0, 0.0}}, {{0.1, 1.0, 0.0}}, {{1.0, 0.5, 0.0}}, {{1.0, 1.5, 0.0}}};
    coarse.region.assign(4, 0);
    const Triangles triangles{{0, 2, 1}, {1, 2, 3}};
    RimPiece wire{.kind = RimKind::kLine, .region = 0, .a = {{0.0, -5.0, 0.0}}, .b = {{0.0, 5.0, 0.0}}};
    const FilmEnds ends = film_ends(coarse, triangles, std::vector{wire}, 0.5);
    EXPECT_EQ(ends.feet.size(), 2U);
    EXPECT_EQ(ends.triangles, (Triangles{{0, 1, 5}, {0, 5, 4}}));
    wire.region = 1;  // of another film
    EXPECT_TRUE(film_ends(coarse, triangles, std::vector{wire}, 0.5).triangles.empty());
}

}  // namespace
}  // namespace lamella::melp
