#include "lamella/render/camera.h"
#include "lamella/render/detail/assumed_thickness.h"
#include "lamella/render/detail/curved_film.h"
#include "lamella/render/detail/particle_average.h"
#include "lamella/render/periodic_images.h"

#include <gtest/gtest.h>

#include "shown_frames.h"

namespace lamella::render::detail {
namespace {

double farthest_from_sphere(const std::vector<std::array<float, 3>>& positions) {
    double worst = 0.0;
    for (const auto& p : positions)
        worst = std::max(worst, std::abs(std::hypot(static_cast<double>(p[0]), static_cast<double>(p[1]),
                                                    static_cast<double>(p[2])) -
                                         1.0));
    return worst;
}

TEST(RefineFilms, RoundsASphere) {
    // Flat triangles lie below the sphere by O(h^2), 0.07 at level 2; the patches by O(h^4), as their normals are
    // exact.
    std::vector<double> error;
    for (const int level : {2, 3, 4}) {
        const FilmPatches patches = film_patches(sphere_film(level).surface);
        EXPECT_TRUE(patches.borders.empty());
        const FineFilms fine =
            refine_films(patches, std::vector<std::array<double, 3>>(patches.triangles.size(), {1.0, 1.0, 1.0}), 3);
        EXPECT_EQ(fine.triangles.size(), 9 * patches.triangles.size());
        for (const float value : fine.value) EXPECT_EQ(value, 1.0F);
        error.push_back(farthest_from_sphere(fine.position));
    }
    EXPECT_LT(error[0], 0.011);
    EXPECT_GT(std::log2(error[0] / error[1]), 3.0);
    EXPECT_GT(std::log2(error[1] / error[2]), 3.0);
}

TEST(FilmPatches, FindRimsAndNormals) {
    const FilmPatches patches = film_patches(flat_film(3).surface);
    EXPECT_EQ(patches.borders.size(), 12U);
    for (const BorderEdge& edge : patches.borders) {
        EXPECT_EQ(edge.films, 1);
        EXPECT_TRUE(edge.on_wire);  // nothing says which vertices are held: every rim is
    }
    for (const Vec3& normal : patches.corner_normal) EXPECT_NEAR(normal[2], 1.0, 1e-12);
    for (const Thread& thread : refine_borders(patches, 2)) {
        EXPECT_TRUE(thread.wire);
        EXPECT_NEAR(thread.points[1][2], 0.0, 1e-12);
    }
}

/// A grid of 61 x 61 particles on the square film, each with what `value` says of its place.
template <class Value>
FilmParticles grid_of_particles(Value&& value) {
    FilmParticles particles;
    for (int j = -30; j <= 30; ++j)
        for (int i = -30; i <= 30; ++i) {
            particles.position.push_back({{i / 30.0, j / 30.0, 0.0}});
            particles.value.push_back(value(i / 30.0));
        }
    return particles;
}

TEST(ParticleAverage, FollowsWhatParticlesCarry) {
    const double spacing = particle_spacing(flat_film(2).surface, 61 * 61);
    EXPECT_NEAR(spacing, 2.0 / 61.0, 1e-12);
    const ParticleAverage one(grid_of_particles([](double) { return 4e-7; }), spacing);
    const ParticleAverage two(grid_of_particles([](double x) { return 1.0 + x; }), spacing);
    EXPECT_NEAR(*one.at({{0.123, -0.4, 0.0}}, {0, 1}), 4e-7, 1e-18);
    EXPECT_NEAR(*two.at({{0.2, 0.1, 0.0}}, {0, 1}), 1.2, 0.01);
    EXPECT_FALSE(one.at({{50.0, 0.0, 0.0}}, {0, 1}));
}

TEST(ParticleAverage, TellsFilmsApart) {
    FilmParticles particles = grid_of_particles([](double) { return 1.0; });
    const FilmParticles other = grid_of_particles([](double) { return 3.0; });
    particles.region.assign(particles.position.size(), 1);
    particles.position.insert(particles.position.end(), other.position.begin(), other.position.end());
    particles.value.insert(particles.value.end(), other.value.begin(), other.value.end());
    particles.region.resize(particles.position.size(), 2);
    const ParticleAverage average(particles, 1.0 / 30.0);
    EXPECT_NEAR(*average.at({{0.1, 0.1, 0.0}}, {1, 0}), 1.0, 1e-12);
    EXPECT_NEAR(*average.at({{0.1, 0.1, 0.0}}, {0, 2}), 3.0, 1e-12);
    EXPECT_NEAR(*average.at({{0.1, 0.1, 0.0}}, {1, 2}), 2.0, 1e-12);
    EXPECT_FALSE(average.at({{0.1, 0.1, 0.0}}, {0, 3}));
}

TEST(ThicknessParticles, AreTheFineOnes) {
    sim::Frame frame = flat_film(2, 5e-7);
    EXPECT_FALSE(thickness_particles(frame));
    frame.points.position = {{{0.0, 0.0, 0.0}}, {{0.5, 0.0, 0.0}}, {{0.0, 0.5, 0.0}}};
    frame.points.fields = {{"thickness", "m", 1, false, {1e-7, 2e-7, 3e-7}}, {"region", "-", 1, true, {1, 1, 2}}};
    EXPECT_EQ(thickness_particles(frame)->value, (std::vector<double>{1e-7, 2e-7, 3e-7}));
    frame.points.fields.push_back({"fine", "-", 1, true, {0, 1, 1}});
    EXPECT_EQ(thickness_particles(frame)->value, (std::vector<double>{2e-7, 3e-7}));
    EXPECT_EQ(thickness_particles(frame)->region, (std::vector<std::int32_t>{1, 2}));
    frame.points.fields.back().values = {0, 0, 0};  // films of even thickness: their vertices know
    EXPECT_FALSE(thickness_particles(frame));
    frame.points.fields.back().values = {1, 1, 1};
    frame.points.radius = {1.0, 1.0, 1.0};  // balls carry no film
    EXPECT_FALSE(thickness_particles(frame));
}

TEST(AssumedThickness, IsThinAboveAndThickBelow) {
    double above = 0.0, below = 0.0;
    for (int i = 0; i < 400; ++i) {
        const double a = 0.1 * i;
        const Vec3 up{{0.6 * std::cos(a), 0.6 * std::sin(a), 0.75}},
            down{{0.6 * std::cos(a), 0.6 * std::sin(a), -0.75}};
        for (const Vec3& place : {up, down}) {
            const double h = assumed_thickness(place, static_cast<std::uint32_t>(i % 7));
            EXPECT_GE(h, 20e-9);
            EXPECT_LE(h, 900e-9);
        }
        above += assumed_thickness(up, 0) / 400;
        below += assumed_thickness(down, 0) / 400;
    }
    EXPECT_LT(above, 320e-9);
    EXPECT_GT(below, 550e-9);
}

TEST(PeriodicImages, JoinAcrossTheBox) {
    sim::Frame frame = flat_film(4, 3e-7);  // 2 x 2 in a box of 2 x 2 x 5
    frame.box = sim::Box{.dimension = 3, .origin = {}, .lengths = {{2.0, 2.0, 5.0}}, .periodic = {true, true, false}};
    const sim::Frame many = periodic_images(frame, 3);
    EXPECT_EQ(many.surface.triangles.size(), 9 * frame.surface.triangles.size());
    EXPECT_EQ(many.surface.regions.size(), many.surface.triangles.size());
    EXPECT_EQ(many.surface.find_of_vertices("thickness")->values.size(), many.surface.position.size());
    const FilmPatches patches = film_patches(many.surface);
    EXPECT_EQ(patches.borders.size(), 4U * 12U);  // the outer rim only
    for (const BorderEdge& edge : patches.borders) EXPECT_FALSE(edge.on_wire);

    frame.box.reset();
    EXPECT_EQ(periodic_images(frame, 2).surface.position.size(), frame.surface.position.size());
}

TEST(PeriodicImages, PutBubblesTogether) {
    const sim::Frame bubble = sphere_film(2);
    sim::Frame frame = bubble;  // each of its triangles with corners of its own, in some other box
    frame.box = sim::Box{.dimension = 3, .origin = {}, .lengths = {{2.5, 2.5, 2.5}}, .periodic = {true, true, true}};
    frame.surface.position.clear();
    for (sim::Field& field : frame.surface.vertex_fields) field.values.clear();
    for (std::size_t t = 0; t < bubble.surface.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 cell{{static_cast<double>(t % 3), static_cast<double>(t % 2), -static_cast<double>(t % 5)}};
            const std::uint32_t v = bubble.surface.triangles[t][k];
            frame.surface.triangles[t][k] = static_cast<std::uint32_t>(frame.surface.position.size());
            frame.surface.position.push_back(bubble.surface.position[v] + 2.5 * cell);
            for (std::size_t f = 0; f < frame.surface.vertex_fields.size(); ++f)
                frame.surface.vertex_fields[f].values.push_back(bubble.surface.vertex_fields[f].values.at(v));
        }
    for (const int count : {1, 2}) {
        const sim::Frame whole = periodic_images(frame, count);
        const auto times = static_cast<std::size_t>(count * count * count);
        EXPECT_EQ(whole.surface.triangles.size(), times * bubble.surface.triangles.size());
        const FilmPatches patches = film_patches(whole.surface);
        EXPECT_EQ(patches.point.size(), times * bubble.surface.position.size());
        EXPECT_TRUE(patches.borders.empty());  // no film ends in the air
        EXPECT_NEAR(frame_bounds(whole).radius, count == 1 ? 1.0 : 1.0 + 1.25 * std::sqrt(3.0), 0.05);
    }
}

}  // namespace
}  // namespace lamella::render::detail
