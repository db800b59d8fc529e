// Operators on films: against finite differences, closed forms and their orders of convergence.

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "lamella/mesh/angles.h"
#include "lamella/mesh/cotan_laplacian.h"
#include "lamella/mesh/mean_curvature.h"
#include "lamella/mesh/quality.h"
#include "lamella/mesh/shapes/power_cluster.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/vertex_area.h"
#include "lamella/mesh/vertex_normals.h"
#include "lamella/core/error.h"
#include "relaxation.h"

namespace lamella::mesh {
namespace {

using namespace test;
using std::numbers::pi;

/// Triple lines, junction points, uneven triangles.
FoamMesh cluster() { return power_cluster(pack_balls({1.0, 0.8, 1.1, 0.9}, 2), 0.5); }
FoamMesh sphere(double radius, int levels) { return spheres({{{{0.3, -0.2, 0.1}}, radius}}, levels); }

double order(const std::function<double(int)>& error_at_level) {
    const double e1 = error_at_level(2), e2 = error_at_level(3), e3 = error_at_level(4);
    return std::min(std::log2(e1 / e2), std::log2(e2 / e3));
}

TEST(Area, OfASphereConvergesAtOrderTwo) {
    EXPECT_GT(order([](int level) { return std::abs(total_area(sphere(1.3, level)) / (4.0 * pi * 1.69) - 1.0); }), 1.9);
}

TEST(Area, IsTheSumOverFilms) {
    const FoamMesh mesh = cluster();
    double sum = 0.0;
    for (const FilmArea& film : film_areas(mesh)) {
        EXPECT_LT(film.a, film.b);
        sum += film.area;
    }
    EXPECT_NEAR(sum / total_area(mesh), 1.0, 1e-13);
}

TEST(AreaGradient, IsTheCentralDifferenceAndSumsToZero) {
    FoamMesh mesh = cluster();
    const auto gradient = area_gradient(mesh);
    Vec3 sum;
    for (const Vec3& g : gradient) sum += g;
    EXPECT_LT(norm(sum), 1e-11);
    const double step = 1e-5;
    for (std::size_t i = 0; i < mesh.position.size(); i += 37)
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId v{static_cast<std::uint32_t>(i)};
            const double x = mesh.position[v][k];
            mesh.position[v][k] = x + step;
            const double plus = total_area(mesh);
            mesh.position[v][k] = x - step;
            const double minus = total_area(mesh);
            mesh.position[v][k] = x;
            EXPECT_NEAR(gradient[v][k], (plus - minus) / (2.0 * step), 1e-7);  // third derivatives ~ 1/h^2
        }
}

TEST(CotanLaplacian, TimesThePositionsIsTheAreaGradient) {
    const FoamMesh mesh = cluster();
    const auto expected = area_gradient(mesh);
    const auto found = cotan_laplacian(mesh) * mesh.position;
    for (const VertexId v : found.ids()) EXPECT_LT(norm(found[v] - expected[v]), 1e-10);
}

TEST(Volumes, OfASphereConvergeAtOrderTwo) {
    EXPECT_GT(order([](int level) {
                  return std::abs(region_volumes(sphere(0.7, level))[RegionId{1}] / (4.0 / 3.0 * pi * 0.343) - 1.0);
              }), 1.9);
}

TEST(VolumeGradient, IsTheCentralDifferenceForEveryRegion) {
    FoamMesh mesh = cluster();
    const auto gradient = volume_gradient(mesh);
    const double step = 1e-2;  // a volume is linear in each coordinate: no truncation error
    for (std::size_t i = 0; i < mesh.position.size(); i += 29)
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId v{static_cast<std::uint32_t>(i)};
            const double x = mesh.position[v][k];
            mesh.position[v][k] = x + step;
            const auto plus = region_volumes(mesh);
            mesh.position[v][k] = x - step;
            const auto minus = region_volumes(mesh);
            mesh.position[v][k] = x;
            for (const RegionId r : plus.ids())
                EXPECT_NEAR(gradient.at(v, r)[k], (plus[r] - minus[r]) / (2.0 * step), 1e-9);
        }
}

TEST(VertexAreas, AddUpToTheFilms) {
    const FoamMesh mesh = cluster();
    double barycentric = 0.0, mixed = 0.0;
    for (const double a : barycentric_areas(mesh)) barycentric += a;
    for (const double a : mixed_voronoi_areas(mesh)) mixed += a;
    EXPECT_NEAR(barycentric / total_area(mesh), 1.0, 1e-12);
    EXPECT_NEAR(mixed / total_area(mesh), 1.0, 1e-12);
}

TEST(MeanCurvature, OfASphereIntegratesToEightPiTimesItsRadius) {
    const auto error = [](int level) {
        const FoamMesh mesh = sphere(2.0, level);
        double inside = 0.0, outside = 0.0;
        for (const EdgeCurvature& e : edge_mean_curvatures(mesh)) (e.region == kOutside ? outside : inside) += e.value;
        EXPECT_NEAR(inside, -outside, 1e-10);
        return std::abs(inside / (16.0 * pi) - 1.0);
    };
    EXPECT_LT(error(4), 2e-3);
    EXPECT_GT(order(error), 1.9);
}

TEST(MeanCurvature, AtVerticesIsHalfOfThatAtTheirEdges) {
    const FoamMesh mesh = cluster();
    double edges = 0.0, vertices = 0.0;
    for (const EdgeCurvature& e : edge_mean_curvatures(mesh)) edges += e.value;
    for (const double h : vertex_mean_curvatures(mesh).value) vertices += h;
    EXPECT_NEAR(edges, vertices, 1e-9 * std::abs(edges) + 1e-9);
}

TEST(VertexNormals, OfASphereAreRadial) {
    for (const NormalWeight weight : {NormalWeight::kArea, NormalWeight::kAngle}) {
        const auto error = [&](int level) {
            const FoamMesh mesh = sphere(1.0, level);
            const auto films = film_normals(mesh, weight);
            const auto out = region_normals(mesh, RegionId{1}, weight);
            double worst = 0.0;
            for (const VertexId v : films.ids()) {
                const Vec3 radial = mesh.position[v] - Vec3{{0.3, -0.2, 0.1}};
                worst = std::max({worst, norm(films[v] - radial), norm(out[v] - radial)});
            }
            return worst;
        };
        EXPECT_LT(error(4), 1e-2);  // edges are 0.07 long
        EXPECT_GT(order(error), 0.9);
    }
}

/// Three strips of film of curvatures k that leave the z axis at 120 degrees, `rows` triangles deep.
FoamMesh bent_tripod(double h, const std::array<double, 3>& k) {
    constexpr int kRows = 6, kAlong = 12;
    FoamMesh mesh;
    for (int r = 0; r < 4; ++r) mesh.regions.push_back({RegionKind::kOpen, 0.0});
    std::vector<VertexId> line;
    for (int i = 0; i <= kAlong; ++i) line.push_back(mesh.add_vertex({{0, 0, i * h}}, i == 0 || i == kAlong));
    for (std::size_t s = 0; s < 3; ++s) {
        const double angle = 2.0 * pi / 3.0 * static_cast<double>(s);
        const Vec3 away{{std::cos(angle), std::sin(angle), 0}};
        const Vec3 across{{-std::sin(angle), std::cos(angle), 0}};
        std::vector<std::vector<VertexId>> rows{line};
        for (int row = 1; row <= kRows; ++row) {
            rows.emplace_back();
            const double t = row * h;
            const double x = k[s] == 0.0 ? t : std::sin(k[s] * t) / k[s];
            const double y = k[s] == 0.0 ? 0.0 : (1.0 - std::cos(k[s] * t)) / k[s];
            for (int i = 0; i <= kAlong; ++i)
                rows.back().push_back(mesh.add_vertex(x * away + y * across + Vec3{{0, 0, i * h}},
                                                      row == kRows || i == 0 || i == kAlong));
        }
        // Counterclockwise about z lies region s + 1, clockwise the one before.
        const auto before = static_cast<RegionId>((s + 2) % 3 + 1);
        const auto after = static_cast<RegionId>(s + 1);
        for (std::size_t row = 0; row < kRows; ++row)
            for (std::size_t i = 0; i < kAlong; ++i) {
                mesh.add_face(rows[row][i], rows[row][i + 1], rows[row + 1][i], before, after);
                mesh.add_face(rows[row + 1][i], rows[row][i + 1], rows[row + 1][i + 1], before, after);
            }
    }
    return mesh;
}

TEST(Angles, OfFlatFilmsAreExact) {
    const auto angles = triple_edge_angles(bent_tripod(0.1, {0, 0, 0}), AngleMethod::kFlat);
    ASSERT_EQ(angles.size(), 12U);
    EXPECT_LT(deviation_from_plateau(angles).largest, 1e-12);
}

TEST(Angles, OfCurvedFilmsConvergeAtOrderOneFlatAndTwoWithPatches) {
    const auto error = [](AngleMethod method, double h) {
        return deviation_from_plateau(triple_edge_angles(bent_tripod(h, {1.0, -0.5, 0.2}), method)).largest;
    };
    const double flat = std::log2(error(AngleMethod::kFlat, 0.1) / error(AngleMethod::kFlat, 0.05));
    const double patch = std::log2(error(AngleMethod::kQuadratic, 0.1) / error(AngleMethod::kQuadratic, 0.05));
    EXPECT_NEAR(flat, 1.0, 0.2);
    EXPECT_GT(patch, 1.7);
    EXPECT_LT(error(AngleMethod::kQuadratic, 0.05), 0.1 * error(AngleMethod::kFlat, 0.05));
}

TEST(Angles, FromWidePatchesForgiveVerticesThatLieOffTheirFilms) {
    // A double bubble with its vertices on the spheres, and the same with every vertex off them by a fraction of the sag of
    // an edge, h^2 / 8.
    const double h = 0.1;
    FoamMesh exact = double_bubble(double_bubble_of_radii(1.0, 1.0), h);
    FoamMesh rough = exact;
    for (const VertexId v : rough.position.ids())
        for (std::size_t k = 0; k < 3; ++k)
            rough.position[v][k] += 0.1 * h * h * std::sin(12.9898 * static_cast<double>(3 * index(v) + k));
    const auto degrees = [](const FoamMesh& mesh, AngleMethod method) {
        return 57.2958 * deviation_from_plateau(triple_edge_angles(mesh, method)).mean;
    };
    EXPECT_LT(degrees(exact, AngleMethod::kWide), 0.3);  // 0.14
    EXPECT_LT(degrees(rough, AngleMethod::kWide), 0.7 * degrees(rough, AngleMethod::kQuadratic));  // 0.28 and 0.50
}

TEST(Angles, AtATetrahedralJunctionAreExact) {
    FoamMesh mesh;
    for (int r = 0; r < 4; ++r) mesh.regions.push_back({RegionKind::kOpen, 0.0});
    const VertexId center = mesh.add_vertex({});
    const std::array<Vec3, 4> corner{{{{1, 1, 1}}, {{1, -1, -1}}, {{-1, 1, -1}}, {{-1, -1, 1}}}};
    std::array<VertexId, 4> at{};
    for (std::size_t i = 0; i < 4; ++i) at[i] = mesh.add_vertex(corner[i], true);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) {
            std::array<std::size_t, 2> rest{};
            std::size_t n = 0;
            for (std::size_t k = 0; k < 4; ++k)
                if (k != i && k != j) rest[n++] = k;
            // Region k lies opposite corner k; the normal points towards corner rest[0], that is into region rest[1].
            const bool forward = dot(cross(corner[i], corner[j]), corner[rest[0]]) > 0.0;
            mesh.add_face(center, forward ? at[i] : at[j], forward ? at[j] : at[i], static_cast<RegionId>(rest[0]),
                          static_cast<RegionId>(rest[1]));
        }
    const auto junctions = junction_angles(mesh, AngleMethod::kFlat);
    ASSERT_EQ(junctions.size(), 1U);
    EXPECT_EQ(junctions[0].vertex, center);
    EXPECT_EQ(junctions[0].angle.size(), 6U);
    EXPECT_LT(deviation_from_plateau(junctions).largest, 1e-12);
}

TEST(Quality, OfAnIcosahedronIsThatOfRegularTriangles) {
    const FoamMesh mesh = sphere(1.0, 0);
    EXPECT_NEAR(min_angle(mesh), pi / 3.0, 1e-12);
    const EdgeLengths edges = edge_lengths(mesh);
    EXPECT_EQ(edges.count, 30U);
    EXPECT_NEAR(edges.shortest, 1.0 / std::sin(0.4 * pi), 1e-12);
    EXPECT_NEAR(edges.longest, edges.mean, 1e-12);
    EXPECT_NEAR(edges.deviation, 0.0, 1e-7);
}

TEST(PowerCluster, IsSoundForAnyNumberOfBubbles) {
    for (const std::size_t n : {1U, 2U, 3U, 4U, 8U, 13U, 40U}) {
        const FoamMesh mesh = power_cluster(pack_balls(std::vector<double>(n, 1.0), n), 0.5);
        EXPECT_TRUE(faults(mesh).empty()) << n;
        EXPECT_EQ(mesh.regions.size(), n + 1);
        for (const double v : region_volumes(mesh)) EXPECT_GE(v, 0.0);
    }
    EXPECT_THROW(power_cluster({}, 0.5), InputError);
    EXPECT_THROW(power_cluster({{{}, 1.0}}, -1.0), InputError);
    EXPECT_THROW(power_cluster({{{}, 1.0}}, 1e-6), InputError);
    EXPECT_THROW(pack_balls({1.0, -2.0}, 1), InputError);
}

}  // namespace
}  // namespace lamella::mesh
