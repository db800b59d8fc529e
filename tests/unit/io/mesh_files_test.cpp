// Films from files: each reader on its own, and each format there and back.

#include "lamella/io/mesh_files.h"

#include "lamella/core/error.h"
#include "lamella/io/frame_files.h"
#include "lamella/mesh/check.h"
#include "lamella/mesh/join.h"
#include "lamella/mesh/shapes/periodic_foam.h"
#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"
#include "lamella/mesh/volume.h"

#include <gtest/gtest.h>

#include "temporary_folder.h"
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace lamella::io {
namespace {

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;
using mesh::VertexId;

/// What a solver shows of a mesh.
sim::Frame frame_of(const FoamMesh& mesh) {
    sim::Frame frame;
    frame.solver = "test";
    sim::Surface& s = frame.surface;
    s.position = mesh.position.values();
    for (const mesh::Face& f : mesh.faces) {
        const auto vertex = [&](std::size_t k) { return static_cast<std::uint32_t>(f.vertices[k]); };
        s.triangles.push_back({vertex(0), vertex(1), vertex(2)});
        s.regions.push_back({static_cast<std::int32_t>(f.back), static_cast<std::int32_t>(f.front)});
    }
    sim::Field held{"on_wire", "-", 1, true, {}};
    for (const std::uint8_t w : mesh.on_wire) held.values.push_back(w);
    s.vertex_fields.push_back(held);
    return frame;
}

/// Two catenoids' worth of everything: bubbles of several valences, open films, a frame with regions of its own.
FoamMesh films() {
    FoamMesh mesh = mesh::triple_bubble(1.0, 0.4);
    mesh::join(mesh, mesh::catenoid({{5, 0, 0}}, {{0, 1, 2}}, 1.0, 0.8, 0.4));
    mesh::join(mesh, mesh::frame_cone(mesh::FrameShape::kCube, {{10, 0, 0}}, 1.0, 0.4));
    mesh::join(mesh, mesh::disk({{15, 0.1, 0}}, {{1, 1, 1}}, 1.0, 0.4));
    for (const RegionId r : mesh.regions.ids())  // files hold the volumes that films have
        if (mesh.regions[r].kind == RegionKind::kClosed) mesh.regions[r].target_volume = mesh::region_volumes(mesh)[r];
    return mesh;
}

FoamMesh there_and_back(const FoamMesh& mesh, void (*write)(std::ostream&, const sim::Frame&), const std::string& name) {
    std::ostringstream out;
    write(out, frame_of(mesh));
    return parse_films(out.str(), name).mesh;
}

void expect_same(FoamMesh found, FoamMesh expected) {
    ASSERT_EQ(found.regions.size(), expected.regions.size());
    for (const RegionId r : found.regions.ids()) {
        EXPECT_EQ(found.regions[r].kind, expected.regions[r].kind) << index(r);
        // The sum runs in another order, or around another point.
        EXPECT_NEAR(found.regions[r].target_volume, expected.regions[r].target_volume,
                    1e-13 * expected.regions[r].target_volume);
        found.regions[r] = expected.regions[r];
    }
    EXPECT_EQ(found, expected);
}

TEST(FilmFiles, ComeBackEqualFromSurfaceEvolver) {
    expect_same(there_and_back(films(), write_surface_evolver, "a.fe"), films());
}

TEST(FilmFiles, ComeBackEqualFromPly) { expect_same(there_and_back(films(), write_ply, "a.ply"), films()); }

TEST(FilmFiles, ComeBackEqualFromObjInOrderOfTheirGroups) {
    FoamMesh expected = films();
    std::stable_sort(expected.faces.begin(), expected.faces.end(), [](const mesh::Face& a, const mesh::Face& b) {
        return std::pair(a.back, a.front) < std::pair(b.back, b.front);
    });
    expect_same(there_and_back(films(), write_obj, "a.obj"), expected);
}

std::string cube() { return test::contents_of(std::filesystem::path(LAMELLA_SOURCE_DIR) / "tests/data/films/box.fe"); }

TEST(SurfaceEvolverReader, FansPolygonsAroundTheirMiddle) {
    const FoamMesh box = parse_surface_evolver(cube(), "box.fe").mesh;
    EXPECT_EQ(box.position.size(), 8U + 6U);
    EXPECT_EQ(box.faces.size(), 24U);
    ASSERT_EQ(box.regions.size(), 8U);  // its only body has number 7; regions 1 to 6 are not there
    EXPECT_EQ(box.regions[RegionId{7}], (mesh::Region{RegionKind::kClosed, 8.0}));
    EXPECT_EQ(box.regions[RegionId{3}].kind, RegionKind::kGone);
    EXPECT_NEAR(mesh::region_volumes(box)[RegionId{7}], 2.0 * 3.0 * std::sqrt(2.0), 1e-14);
    for (const mesh::Face& face : box.faces) {
        EXPECT_EQ(face.back, RegionId{7});
        EXPECT_EQ(face.front, mesh::kOutside);
    }
}

TEST(SurfaceEvolverReader, KnowsExpressions) {
    const auto place = [](const std::string& expressions) {
        return parse_surface_evolver("parameter r = 2*(1+1) // four\nPARAMETER s=-r^2/8\nvertices\n1 " + expressions +
                                         " fixed\n2 9 0 0 fixed\n3 0 9 \\\n 0 fixed\nedges\n1 1 2 fixed\n2 2 3 fixed\n"
                                         "3 3 1 fixed\nfaces\n1 1 2 3\n",
                                     "e.fe")
            .mesh.position[VertexId{0}];
    };
    EXPECT_EQ(place("r s -1"), (Vec3{{4, -2, -1}}));
    EXPECT_EQ(place("1 -1 -2"), (Vec3{{1, -1, -2}}));              // three numbers ...
    EXPECT_EQ(place("1 - 1 2-3 (4 -1)"), (Vec3{{0, -1, 3}}));      // ... and three differences
    EXPECT_EQ(place("2^3^2/2^8 -2^2 1"), (Vec3{{2, -4, 1}}));
    EXPECT_EQ(place("sqrt(16) cos(pi)*R/* twice */*2 .5e1"), (Vec3{{4, -8, 5}}));
    EXPECT_EQ(place("abs(-3) 10/4/5 2**3"), (Vec3{{3, 0.5, 8}}));
}

TEST(SurfaceEvolverReader, SidesWithoutBodiesAreAirOnEitherSideOfAWire) {
    const std::string disk = "vertices\n1 0 0 0 fixed\n2 1 0 0 fixed\n3 1 1 0 fixed\n4 0 1 0 fixed\nedges\n1 1 2 fixed\n"
                             "2 2 3 fixed\n3 3 4 fixed\n4 4 1 fixed\nfaces\n1 1 2 3 4 tension 1.5\nread\nanything { goes\n";
    const FilmFile film = parse_surface_evolver(disk, "d.fe");
    ASSERT_EQ(film.mesh.regions.size(), 2U);
    EXPECT_EQ(film.mesh.regions[RegionId{1}].kind, RegionKind::kOpen);
    EXPECT_EQ(film.mesh.faces[mesh::FaceId{0}].front, mesh::kOutside);
    EXPECT_EQ(film.mesh.on_wire.values(), (std::vector<std::uint8_t>{1, 1, 1, 1, 0}));
    ASSERT_EQ(film.tensions.size(), 1U);
    EXPECT_EQ(film.tensions[0].factor, 1.5);
    EXPECT_EQ(film.tensions[0].b, RegionId{1});
}

TEST(SurfaceEvolverReader, ABodyWithoutVolumeIsOpen) {
    std::string text = cube();
    text.erase(text.rfind("volume"));
    const FoamMesh box = parse_surface_evolver(text, "box.fe").mesh;
    EXPECT_EQ(box.regions[RegionId{7}].kind, RegionKind::kOpen);
}

TEST(SurfaceEvolverReader, FollowsBoundaryCurvesAroundATurn) {
    // A triangle of vertices on a circle of radius 2; the last edge goes from 240 degrees to 0.
    const FoamMesh film = parse_surface_evolver("boundary 1 parameters 1\nx1: 2*cos(p1)\nx2: 2*sin(p1)\nx3: 1\nvertices\n"
                                                "1 0 boundary 1 fixed\n2 2*pi/3 boundary 1 fixed\n3 4*pi/3 boundary 1\n"
                                                "edges\n1 1 2 boundary 1 fixed\n2 2 3 boundary 1 fixed\n3 3 1 boundary 1\n"
                                                "faces\n1 1 2 3\n",
                                                "b.fe")
                              .mesh;
    EXPECT_EQ(film.faces.size(), 12U);
    for (const VertexId v : film.position.ids()) {
        const Vec3& x = film.position[v];
        EXPECT_NEAR(x[2], 1.0, 1e-15);
        EXPECT_NEAR(std::hypot(x[0], x[1]), film.on_wire[v] != 0 ? 2.0 : 0.0, 1e-14);
    }
    EXPECT_EQ(std::count(film.on_wire.begin(), film.on_wire.end(), 1), 12);
}

TEST(SurfaceEvolverReader, WrapsATorus) {
    const auto path = std::filesystem::path(LAMELLA_SOURCE_DIR) / "tests/data/films/kelvin.fe";
    const FoamMesh foam = read_films(path).mesh;
    EXPECT_TRUE(foam.periodic());
    EXPECT_EQ(foam.period[1], (Vec3{{0, 2, 0}}));
    ASSERT_EQ(foam.regions.size(), 3U);
    const auto volumes = mesh::region_volumes(foam);
    EXPECT_EQ(foam.regions[RegionId{1}].target_volume, 4.0);
    // Kelvin's cells fill the torus: the films enclose what there is, up to whole periods between images.
    const double sum = volumes[RegionId{1}] + volumes[RegionId{2}];
    EXPECT_NEAR(sum - 8.0 * std::round(sum / 8.0), 0.0, 1e-12);
}

TEST(ObjReader, ClosedSurfacesAreBubblesWhateverTheirNormals) {
    FoamMesh balls = mesh::spheres({{{{0, 0, 0}}, 1.0}, {{{3, 0, 0}}, 0.5}}, 0.4);
    std::ostringstream out;
    for (const Vec3& x : balls.position) out << "v " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
    out << "o balls\ns off\nusemtl soap\n";
    for (const mesh::FaceId f : balls.faces.ids()) {
        auto v = balls.faces[f].vertices;
        if (index(f) % 3 == 0) std::swap(v[1], v[2]);
        out << "f";
        for (const VertexId corner : v) out << ' ' << index(corner) + 1 << "//1";
        out << '\n';
    }
    const FoamMesh found = parse_obj(out.str(), "balls.obj").mesh;
    ASSERT_EQ(found.regions.size(), 3U);
    const auto volumes = mesh::region_volumes(balls);
    for (const RegionId r : {RegionId{1}, RegionId{2}}) {
        EXPECT_EQ(found.regions[r].kind, RegionKind::kClosed);
        EXPECT_NEAR(found.regions[r].target_volume, volumes[r], 1e-4 * volumes[r]);  // six digits were written
    }
}

TEST(ObjReader, FindsTheCellsOfAClusterWithoutLabels) {
    const FoamMesh cluster = mesh::quadruple_bubble(1.0, 0.4);
    std::ostringstream out;
    out.precision(17);
    for (const Vec3& x : cluster.position) out << "v " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
    for (const mesh::Face& f : cluster.faces)
        out << "f " << index(f.vertices[0]) + 1 << ' ' << index(f.vertices[1]) + 1 << ' ' << index(f.vertices[2]) + 1 << '\n';
    const FoamMesh found = parse_obj(out.str(), "cluster.obj").mesh;
    ASSERT_EQ(found.regions.size(), 5U);
    for (const RegionId r : found.regions.ids())
        EXPECT_EQ(found.regions[r].kind, r == mesh::kOutside ? RegionKind::kOpen : RegionKind::kClosed);
}

TEST(ObjReader, TheRimOfAnOpenSurfaceIsAWire) {
    const FoamMesh film = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 0\nf 1 2 5\nf 2 3 -1\nf 3 4 5\nf 4 1 5\n", "f.obj").mesh;
    EXPECT_EQ(film.on_wire.values(), (std::vector<std::uint8_t>{1, 1, 1, 1, 0}));
    ASSERT_EQ(film.regions.size(), 2U);
    EXPECT_EQ(film.regions[RegionId{1}].kind, RegionKind::kOpen);
}

TEST(PlyReader, ReadsTextWithOtherElementsAndTypes) {
    const std::string text =
        "ply\nformat ascii 1.0\ncomment from elsewhere\nelement material 1\nproperty uchar red\nproperty list uchar float rest\n"
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar quality\n"
        "element face 4\nproperty list uint8 int32 vertex_index\nend_header\n7 2 1.5 2.5\n"
        "0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3";
    const FoamMesh found = parse_ply(text, "t.ply").mesh;
    ASSERT_EQ(found.regions.size(), 2U);
    EXPECT_NEAR(found.regions[RegionId{1}].target_volume, 1.0 / 6.0, 1e-15);
}

}  // namespace
}  // namespace lamella::io
