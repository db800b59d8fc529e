#include "lamella/render/baked_frame.h"

#include "lamella/core/error.h"
#include "lamella/optics/film_colors.h"

#include <gtest/gtest.h>

#include "shown_frames.h"

namespace lamella::render {
namespace {

/// Three squares that meet at the line x = 0, z = 0 in angles of 120 degrees.
sim::Frame three_films() {
    sim::Frame frame;
    sim::Surface& s = frame.surface;
    s.position = {{{0, 0, 0}}, {{0, 1, 0}}};
    for (int k = 0; k < 3; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / 3.0;
        for (const double y : {0.0, 1.0}) s.position.push_back({{std::cos(angle), y, std::sin(angle)}});
        const auto a = static_cast<std::uint32_t>(2 + 2 * k);
        s.triangles.push_back({0, a, a + 1});
        s.triangles.push_back({0, a + 1, 1});
        for (int i = 0; i < 2; ++i) s.regions.push_back({k, (k + 1) % 3});
    }
    s.vertex_fields.push_back({"velocity", "m/s", 3, false, std::vector<double>(24, 0.5)});
    s.face_fields.push_back({"film", "-", 1, true, {0, 0, 1, 1, 2, 2}});
    return frame;
}

TEST(BakedFrame, CutsFilmsApartAlongTheirBorders) {
    const sim::Frame frame = three_films(), baked = baked_frame(frame);
    const sim::Surface& s = baked.surface;
    EXPECT_EQ(s.position.size(), 12U);  // four of each film
    EXPECT_EQ(s.triangles.size(), 6U);
    const sim::Field& normal = *s.find_of_vertices("normal");
    for (std::size_t t = 0; t < 6; ++t) {
        EXPECT_LT(s.regions[t][0], s.regions[t][1]);
        const auto& [a, b, c] = s.triangles[t];
        const Vec3 area = cross(s.position[b] - s.position[a], s.position[c] - s.position[a]);
        for (const std::uint32_t v : s.triangles[t]) {
            const Vec3 n{{normal.values[3 * v], normal.values[3 * v + 1], normal.values[3 * v + 2]}};
            EXPECT_NEAR(dot(n, area) / norm(area), 1.0, 1e-12);  // flat films, and triangles turned like their normals
        }
    }
    EXPECT_EQ(s.find_of_vertices("velocity")->values, std::vector<double>(36, 0.5));
    EXPECT_EQ(s.find_of_faces("film")->values, (std::vector<double>{0, 0, 1, 1, 2, 2}));
    EXPECT_EQ(baked.find_scalar("thickness_assumed")->value, 1.0);
}

TEST(BakedFrame, KnowsThicknessAndColor) {
    const sim::Frame baked = baked_frame(flat_film(2, 300e-9));
    EXPECT_EQ(baked.find_scalar("thickness_assumed")->value, 0.0);
    for (const double nm : baked.surface.find_of_vertices("thickness_nm")->values) EXPECT_NEAR(nm, 300.0, 1e-9);
    const optics::FilmColors colors;
    const double bright = 0.45 / optics::luminance(colors.reflected_by_thick_film(1.0));
    const auto expected = optics::display_color(bright * colors.reflected(300e-9, 1.0));
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(baked.surface.find_of_vertices("color")->values[k], expected[k], 1.0);
}

TEST(BakedFrame, ColorsBallsAndFilmsByAField) {
    EXPECT_EQ(baked_frame(one_ball(), "pressure").points.find("color")->values.size(), 3U);
    const sim::Frame by_field = baked_frame(flat_film(2, 300e-9), "thickness");
    EXPECT_NE(by_field.surface.find_of_vertices("color")->values,
              baked_frame(flat_film(2, 300e-9)).surface.find_of_vertices("color")->values);
    EXPECT_THROW(baked_frame(one_ball(), "presure"), InputError);
    EXPECT_THROW(baked_frame({}), InputError);
}

}  // namespace
}  // namespace lamella::render
