#include "view/film_parts.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include "films.h"

namespace lamella::app::view {
namespace {

TEST(FilmParts, GivesEachFilmItsOwnVerticesOnABorder) {
    const sim::Frame frame = three_sheets(4);
    const FilmParts parts = film_parts(frame.surface);
    // 25 vertices a sheet: the 5 on the axis come three times.
    EXPECT_EQ(frame.surface.position.size(), 65u);
    EXPECT_EQ(parts.vertices.size(), 75u);
    ASSERT_EQ(parts.triangles.size(), frame.surface.triangles.size());
    for (std::size_t f = 0; f < parts.triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(parts.vertices[parts.triangles[f][k]].source, frame.surface.triangles[f][k]);
}

TEST(FilmParts, HasNormalsIntoTheLargerRegionWhateverTheTrianglesTurn) {
    const sim::Frame frame = three_sheets(3);
    for (const FilmParts::Vertex& vertex : film_parts(frame.surface).vertices) {
        ASSERT_NEAR(norm(vertex.normal), 1.0, 1e-14);
        // Region r lies at the angle (2 r - 1) 60 degrees.
        const double angle = (2.0 * vertex.regions[1] - 1.0) * std::numbers::pi / 3.0;
        EXPECT_GT(dot(vertex.normal, Vec3{{std::cos(angle), std::sin(angle), 0.0}}), 0.5);
    }
}

TEST(FilmParts, FindsBordersAndRims) {
    const sim::Surface surface = with_outside(three_sheets(4).surface);
    const FilmParts parts = film_parts(surface);
    EXPECT_EQ(parts.borders.size(), 4u);
    EXPECT_EQ(parts.wires.size(), 3u * 3u * 4u);
    for (const auto& ends : parts.borders)
        for (const std::uint32_t end : ends)
            EXPECT_EQ(std::abs(surface.position[end][0]) + std::abs(surface.position[end][1]), 0.0);
}

TEST(FilmParts, FindsTheBordersOfTrianglesThatShareNoVertex) {
    const sim::Surface shared = three_sheets(4).surface;
    sim::Surface loose;
    loose.regions = shared.regions;
    for (const auto& triangle : shared.triangles) {
        const auto first = static_cast<std::uint32_t>(loose.position.size());
        for (const std::uint32_t v : triangle) loose.position.push_back(shared.position[v]);
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    const FilmParts parts = film_parts(with_outside(loose));
    EXPECT_EQ(parts.vertices.size(), 75u);
    EXPECT_EQ(parts.borders.size(), 4u);
}

TEST(FilmParts, TakesABorderAlongAWireForTheWire) {
    sim::Surface surface = three_sheets(4).surface;
    sim::Field on_wire{"on_wire", "-", 1, true, std::vector<double>(surface.position.size(), 0.0)};
    for (std::size_t v = 0; v < 5; ++v) on_wire.values[v] = 1.0;
    surface.vertex_fields.push_back(on_wire);
    const FilmParts parts = film_parts(surface);
    EXPECT_EQ(parts.wires.size(), 4u);
    EXPECT_EQ(parts.borders.size(), 3u * 3u * 4u);  // films that end on nothing have a rim of liquid
}

TEST(FilmParts, TakesTheRimsOfAFoamWithoutOutsideForBorders) {
    const FilmParts inside = film_parts(three_sheets(4).surface);  // regions 1, 2 and 3
    EXPECT_TRUE(inside.wires.empty());
    EXPECT_EQ(inside.borders.size(), 4u + 3u * 3u * 4u);
}

TEST(FilmParts, RefusesTrianglesWithoutTheirVertices) {
    sim::Surface surface = three_sheets(1).surface;
    surface.triangles[0][1] = 99;
    EXPECT_THROW(film_parts(surface), InputError);
    surface = three_sheets(1).surface;
    surface.regions.pop_back();
    EXPECT_THROW(film_parts(surface), InputError);
}

}  // namespace
}  // namespace lamella::app::view
