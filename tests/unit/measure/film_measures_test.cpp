#include "lamella/measure/film_measures.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/measure/measure.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"
#include "lamella/mesh/subdivide.h"

#include <gtest/gtest.h>

#include "film_frames.h"
#include <bit>
#include <cmath>
#include <numbers>

namespace lamella::measure {
namespace {

using test::film_frame;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

FilmMeasures measured(const sim::Frame& frame) { return film_measures(frame).value(); }

TEST(FilmMeasures, OfASphereAreThoseOfItsFormulas) {
    constexpr double kRadius = 0.7;
    const Vec3 center{{3.0, -1.0, 5.0}};
    for (const double edge : {0.2, 0.1, 0.05}) {
        const sim::Frame frame = film_frame(mesh::spheres({{center, kRadius}}, edge * kRadius));
        const FilmMeasures m = measured(frame);
        // Inscribed polyhedra: errors of order h^2 / R^2, with a factor below 1/2.
        const double tolerance = 0.5 * edge * edge;
        const double area = 4.0 * kPi * kRadius * kRadius;
        EXPECT_NEAR(m.total_area / area, 1.0, tolerance);
        ASSERT_EQ(m.films.size(), 1U);
        EXPECT_EQ(m.films[0].a, 0);
        EXPECT_EQ(m.films[0].b, 1);
        EXPECT_NEAR(m.films[0].area / m.total_area, 1.0, 1e-12);
        EXPECT_NEAR(m.films[0].curvature * kRadius / 2.0, 1.0, tolerance);
        EXPECT_NEAR(m.films[0].fit_radius, kRadius, 1e-12);
        ASSERT_EQ(m.regions.size(), 1U);
        EXPECT_EQ(m.regions[0].id, 1);
        EXPECT_NEAR(m.regions[0].volume / (area * kRadius / 3.0), 1.0, 2.0 * tolerance);
        EXPECT_NEAR(m.volume_error, 1.0 - m.regions[0].volume / (area * kRadius / 3.0), 1e-12);
        EXPECT_EQ(m.regions[0].pressure, 10.0);
        EXPECT_NEAR(norm(m.regions[0].centroid - center), 0.0, 1e-12);
        EXPECT_EQ(m.edge_angles.curved.count, 0U);
        EXPECT_TRUE(std::isnan(m.edge_angles.curved.max_error));
        EXPECT_EQ(m.mesh.vertices, frame.surface.position.size());
        EXPECT_EQ(m.mesh.faces, frame.surface.triangles.size());
        EXPECT_NEAR(m.mesh.mean_edge / (edge * kRadius), 1.0, 0.25);
        EXPECT_EQ(film_intersections(frame), 0U);
    }
}

/// Films of which wires or plates close in the gas: flat ends count.
TEST(FilmMeasures, OfGasBeyondOpenFilmsReachToTheirRims) {
    const auto as_bubble = [](mesh::FoamMesh films) {
        films.regions[mesh::RegionId{1}].kind = mesh::RegionKind::kClosed;
        return measured(film_frame(films)).regions.at(0);
    };
    const Vec3 center{{1.0, 2.0, -4.0}}, axis{{0.0, 0.6, 0.8}};
    constexpr double kEdge = 0.1, kFine = kEdge * kEdge;
    const RegionMeasure half = as_bubble(mesh::hemisphere(center, axis, 1.0, kEdge));
    EXPECT_NEAR(half.volume, 2.0 / 3.0 * kPi, 2.0 * kFine);
    EXPECT_NEAR(norm(half.centroid - (center + 0.375 * axis)), 0.0, kFine);
    const RegionMeasure tube = as_bubble(mesh::cylinder(center, axis, 1.0, 1.5, kEdge));  // ends that look away
    EXPECT_NEAR(tube.volume, 1.5 * kPi, 2.0 * kFine);
    EXPECT_NEAR(norm(tube.centroid - center), 0.0, 1e-12);
}

TEST(FilmMeasures, OfTheExactDoubleBubbleAreItsClosedForm) {
    const mesh::DoubleBubble exact = mesh::double_bubble_of_volumes(1.0, 0.5);
    double before = 0.0;
    for (const double edge : {0.12, 0.06}) {
        const FilmMeasures m = measured(film_frame(mesh::double_bubble(exact, edge)));
        EXPECT_NEAR(m.total_area / exact.area(), 1.0, edge * edge);
        ASSERT_EQ(m.films.size(), 3U);  // 0-1, 0-2, 1-2
        EXPECT_NEAR(m.films[0].area / exact.area1, 1.0, 2.0 * edge * edge);
        EXPECT_NEAR(m.films[1].area / exact.area2, 1.0, 2.0 * edge * edge);
        EXPECT_NEAR(m.films[2].area / exact.partition_area, 1.0, 2.0 * edge * edge);
        EXPECT_NEAR(m.films[0].fit_radius / exact.radius1, 1.0, 1e-9);
        EXPECT_NEAR(m.films[1].fit_radius / exact.radius2, 1.0, 1e-9);
        EXPECT_NEAR(m.films[2].fit_radius * exact.partition_curvature, 1.0, 1e-6);
        EXPECT_NEAR(m.films[0].curvature * exact.radius1 / 2.0, 1.0, 4.0 * edge * edge);
        EXPECT_NEAR(m.films[2].curvature / (2.0 * exact.partition_curvature), 1.0, 0.05);  // bulges out of the smaller
        ASSERT_EQ(m.regions.size(), 2U);
        EXPECT_NEAR(m.regions[0].volume, exact.volume1, 3.0 * edge * edge);
        EXPECT_EQ(m.regions[0].area, m.films[0].area + m.films[2].area);
        EXPECT_NEAR(m.regions[0].centroid[1], 0.0, 1e-3);
        EXPECT_LT(m.regions[0].centroid[0], 0.0);
        EXPECT_GT(m.regions[1].centroid[0], 0.0);
        // Vertices on the exact caps: flat facets are off by O(h), fitted films by O(h^2).
        EXPECT_GT(m.edge_angles.curved.count, 20U);
        EXPECT_NEAR(m.edge_angles.curved.mean, 120.0 * kDegree, 1e-9);  // three angles add up to a full turn
        EXPECT_LT(m.edge_angles.curved.mean_error, 0.3 * m.edge_angles.flat.mean_error);
        EXPECT_LT(m.edge_angles.curved.max_error, 4.0 * kDegree);
        if (before > 0.0) {
            EXPECT_LT(m.edge_angles.curved.mean_error, 0.4 * before);
        }
        before = m.edge_angles.curved.mean_error;
        EXPECT_FALSE(m.has_patches);
        EXPECT_EQ(m.corner_angles.curved.count, 0U);
    }
}

TEST(FilmMeasures, FindTheAnglesOfTheConeInATetrahedron) {
    // Six flat triangles from the edges of a tetrahedron to its center: both laws hold exactly.
    const FilmMeasures m = measured(film_frame(mesh::frame_cone(mesh::FrameShape::kTetrahedron, {}, 1.0, 0.1)));
    EXPECT_EQ(m.films.size(), 6U);
    for (const FilmMeasure& film : m.films) {
        EXPECT_NEAR(film.area, 1.0606601717798214 / 6.0, 1e-12);
        EXPECT_TRUE(std::isinf(film.fit_radius));
        EXPECT_NEAR(film.curvature, 0.0, 1e-10);
    }
    EXPECT_TRUE(m.regions.empty());
    EXPECT_TRUE(std::isnan(m.volume_error));
    for (const AnglesByMethod& angles : {m.edge_angles, m.corner_angles})
        for (const AngleMeasure& a : {angles.flat, angles.curved}) {
            EXPECT_GT(a.count, 0U);
            EXPECT_LT(a.max_error, 1e-6);
            EXPECT_LE(a.mean_error, a.max_error);
        }
    EXPECT_EQ(m.corner_angles.curved.count, 1U);
    EXPECT_NEAR(m.corner_angles.curved.mean, std::acos(-1.0 / 3.0), 1e-6);
    EXPECT_NEAR(m.edge_angles.curved.mean, 120.0 * kDegree, 1e-6);
}

/// Quadratic triangles whose middle nodes lie on the exact caps of a double bubble.
sim::Field exact_patches(const mesh::FoamMesh& mesh, const mesh::DoubleBubble& exact) {
    const double x1 = -std::sqrt(exact.radius1 * exact.radius1 - exact.circle_radius * exact.circle_radius);
    const double x2 = x1 + exact.center_distance;
    const double radius_p = 1.0 / exact.partition_curvature;
    const double xp = std::sqrt(radius_p * radius_p - exact.circle_radius * exact.circle_radius);
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    std::vector<Vec3> middle(3 * mesh.faces.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto uses = edges.of(e);
        const Vec3 flat = 0.5 * (mesh.position[edges.edge[e].a] + mesh.position[edges.edge[e].b]);
        for (const mesh::EdgeUse& use : uses) {
            const mesh::Face& face = mesh.faces[use.face];
            const auto low = std::min(index(face.back), index(face.front)), high = std::max(index(face.back), index(face.front));
            const Vec3 center{{low > 0 ? xp : high == 1 ? x1 : x2, 0.0, 0.0}};
            const double radius = low > 0 ? radius_p : high == 1 ? exact.radius1 : exact.radius2;
            Vec3 on_film = center + (radius / norm(flat - center)) * (flat - center);
            if (uses.size() == 3) on_film = (exact.circle_radius / norm(flat)) * flat;  // the circle lies in x = 0
            middle[3 * index(use.face) + (use.opposite + 1) % 3] = on_film;
        }
    }
    sim::Field field{sim::kCurvedNodes, "m", 18, false, {}};
    for (const mesh::FaceId f : mesh.faces.ids()) {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t a = 0; a < 3; ++a) field.values.push_back(mesh.corner(f, k)[a]);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t a = 0; a < 3; ++a) field.values.push_back(middle[3 * index(f) + k][a]);
    }
    return field;
}

TEST(FilmMeasures, TakeAnglesFromQuadraticTrianglesWhereTheFrameHasThem) {
    const mesh::DoubleBubble exact = mesh::double_bubble_of_volumes(1.0, 0.5);
    double before = 0.0;
    for (const double edge : {0.12, 0.06}) {
        const mesh::FoamMesh mesh = mesh::double_bubble(exact, edge);
        sim::Frame frame = film_frame(mesh);
        frame.surface.face_fields.push_back(exact_patches(mesh, exact));
        const FilmMeasures m = measured(frame);
        EXPECT_TRUE(m.has_patches);
        EXPECT_NEAR(m.edge_angles.curved.mean, 120.0 * kDegree, 1e-9);
        const double bend = edge / exact.radius2;  // parabolas miss a tenth of its square
        EXPECT_LT(m.edge_angles.curved.max_error, 0.15 * bend * bend);
        if (before > 0.0) {
            EXPECT_LT(m.edge_angles.curved.mean_error, 0.35 * before);  // O(h^2)
        }
        before = m.edge_angles.curved.mean_error;
    }
}

TEST(FilmMeasures, WeightThicknessWithArea) {
    const mesh::FoamMesh mesh = mesh::spheres({{{}, 1.0}}, 0.1);
    sim::Frame frame = film_frame(mesh);
    sim::Field thickness{"thickness", "m", 1, false, {}};
    for (const Vec3& x : mesh.position) thickness.values.push_back(1e-6 * (1.0 + 0.5 * x[2]));
    frame.surface.vertex_fields.push_back(thickness);
    const ThicknessMeasure t = measured(frame).thickness.value();
    EXPECT_NEAR(t.mean, 1e-6, 1e-10);
    EXPECT_NEAR(t.deviation, 0.5e-6 / std::sqrt(3.0), 2e-9);  // z is uniform on a sphere
    EXPECT_NEAR(t.min, 0.5e-6, 1e-8);
    EXPECT_NEAR(t.max, 1.5e-6, 1e-8);
    EXPECT_FALSE(measured(film_frame(mesh)).thickness.has_value());
}

TEST(FilmMeasures, WorkOnFilesThatKnowNothingOfRegionsAndWires) {
    const mesh::FoamMesh mesh = mesh::double_bubble(mesh::double_bubble_of_volumes(1.0, 0.5), 0.1);
    sim::Frame frame = film_frame(mesh);
    const FilmMeasures with = measured(frame);
    frame.surface.vertex_fields.clear();
    frame.surface.region_fields.clear();
    const FilmMeasures without = measured(frame);
    ASSERT_EQ(without.regions.size(), 2U);
    EXPECT_EQ(without.regions[1].volume, with.regions[1].volume);
    EXPECT_TRUE(std::isnan(without.regions[1].pressure));
    EXPECT_TRUE(std::isnan(without.volume_error));
    EXPECT_EQ(without.edge_angles.curved.mean_error, with.edge_angles.curved.mean_error);
    // A film on a wire closes nothing in.
    sim::Frame cone = film_frame(mesh::frame_cone(mesh::FrameShape::kTetrahedron, {}, 1.0, 0.1));
    cone.surface.vertex_fields.clear();
    cone.surface.region_fields.clear();
    EXPECT_TRUE(measured(cone).regions.empty());
    EXPECT_LT(measured(cone).edge_angles.curved.max_error, 1e-6);
}

TEST(FilmMeasures, TakeNoMemoryForALargeRegionNumber) {
    sim::Frame frame = film_frame(mesh::spheres({{{}, 1.0}}, 0.3));
    frame.surface.region_fields.clear();
    for (auto& sides : frame.surface.regions)
        for (std::int32_t& r : sides)
            if (r == 1) r = 2147483647;
    const FilmMeasures m = measured(frame);
    ASSERT_EQ(m.regions.size(), 1U);
    EXPECT_EQ(m.regions[0].id, 2147483647);
}

TEST(FilmMeasures, RefuseDamagedFrames) {
    const sim::Frame good = film_frame(mesh::spheres({{{}, 1.0}}, 0.5));
    const auto expect_refused = [&](auto&& damage) {
        sim::Frame frame = good;
        damage(frame.surface);
        EXPECT_THROW(film_measures(frame), InputError);
        EXPECT_THROW(film_intersections(frame), InputError);
    };
    expect_refused([](sim::Surface& s) { s.regions.pop_back(); });
    expect_refused([](sim::Surface& s) { s.triangles[3][1] = 1000000; });
    expect_refused([](sim::Surface& s) { s.triangles[3][1] = s.triangles[3][2]; });
    expect_refused([](sim::Surface& s) { s.regions[2][0] = -1; });
    expect_refused([](sim::Surface& s) { s.position[4][1] = std::nan(""); });
    expect_refused([](sim::Surface& s) { s.vertex_fields[0].values.pop_back(); });
}

TEST(FilmMeasures, CountFilmsThatCutEachOther) {
    sim::Frame frame = film_frame(mesh::spheres({{{}, 1.0}, {{{3.0, 0.0, 0.0}}, 1.0}}, 0.3));
    EXPECT_EQ(film_intersections(frame), 0U);
    for (Vec3& x : frame.surface.position)
        if (x[0] > 1.5) x[0] -= 1.5;
    EXPECT_GT(film_intersections(frame).value(), 10U);
    EXPECT_EQ(film_intersections(frame, 5), 5U);
}

TEST(FilmMeasures, AreTheSameBitsOnAnyNumberOfThreads) {
    const sim::Frame frame = film_frame(mesh::double_bubble(mesh::double_bubble_of_volumes(1.0, 0.3), 0.04));
    const auto bits = [&] {
        std::vector<std::uint64_t> all;
        const FilmMeasures m = measured(frame);
        for (const sim::Scalar& s : film_scalars(m)) all.push_back(std::bit_cast<std::uint64_t>(s.value));
        for (const FilmMeasure& f : m.films)
            for (const double v : {f.area, f.curvature, f.fit_radius}) all.push_back(std::bit_cast<std::uint64_t>(v));
        for (const RegionMeasure& r : m.regions)
            for (std::size_t k = 0; k < 3; ++k) all.push_back(std::bit_cast<std::uint64_t>(r.centroid[k]));
        return all;
    };
    std::vector<std::uint64_t> one;
    {
        const ThreadLimit limit(1);
        one = bits();
    }
    const ThreadLimit limit(4);
    EXPECT_EQ(bits(), one);
}

TEST(FilmMeasures, AreAmongTheValuesOfASeries) {
    const auto values = measure_frame(film_frame(mesh::spheres({{{}, 1.0}}, 0.2)));
    EXPECT_NEAR(find_value(values, "total_area").value(), 4.0 * kPi, 0.2);
    EXPECT_NEAR(find_value(values, "volume_1").value(), find_value(values, "gas_volume").value(), 1e-15);
    EXPECT_EQ(find_value(values, "pressure_1"), 10.0);
    EXPECT_TRUE(std::isnan(find_value(values, "edge_angle_max_error").value()));
    EXPECT_FALSE(find_value(values, "thickness_mean").has_value());
    EXPECT_TRUE(measure_frame({}).empty());
}

}  // namespace
}  // namespace lamella::measure
