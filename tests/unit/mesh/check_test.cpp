// The audit finds what is broken, names it, and agrees with the brute-force audit of relaxation.h.

#include "lamella/mesh/check.h"

#include "lamella/core/error.h"
#include "lamella/mesh/join.h"
#include "lamella/mesh/plateau_faults.h"
#include "lamella/mesh/shapes/periodic_foam.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"
#include "lamella/mesh/subdivide.h"
#include "relaxation.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace lamella::mesh {
namespace {

FoamMesh sound() { return double_bubble(double_bubble_of_volumes(1.0, 0.5), 0.25); }

TEST(Check, FindsNothingInSoundMeshes) {
    for (const FoamMesh& mesh :
         {sound(), disk({}, {{0.0, 0.0, 1.0}}, 1.0, 0.2), frame_cone(FrameShape::kCube, {}, 1.0, 0.3),
          periodic_foam(PeriodicFoam::kKelvin, 1.0, 0.2), periodic_foam(PeriodicFoam::kWeairePhelan, 1.0, 0.3)}) {
        for (const std::string& fault : faults(mesh)) ADD_FAILURE() << fault;
        EXPECT_NO_THROW(require_sound(mesh, "mesh"));
    }
}

struct Damage {
    const char* says;
    std::function<void(FoamMesh&)> make;
    bool brute_force_sees = true;
};

TEST(Check, NamesWhatIsBroken) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Damage> damages{
        {"vertex 7 is not at a finite place", [&](FoamMesh& m) { m.position[VertexId{7}][1] = nan; }, false},
        {"face 3 has vertex 4000000 of", [](FoamMesh& m) { m.faces[FaceId{3}].vertices[1] = VertexId{4000000}; }, false},
        {"face 3 has region 9 of 3", [](FoamMesh& m) { m.faces[FaceId{3}].front = RegionId{9}; }},
        {"has region 1 on both sides",
         [](FoamMesh& m) { m.faces.values().back().back = m.faces.values().back().front = RegionId{1}; }},
        {"face 5 has a vertex twice",
         [](FoamMesh& m) { m.faces[FaceId{5}].vertices[1] = m.faces[FaceId{5}].vertices[0]; }, false},
        {"have the same vertices", [](FoamMesh& m) { m.faces.push_back(m.faces[FaceId{5}]); }},
        {"does not close region", [](FoamMesh& m) { m.faces.pop_back(); }},
        {"does not close region", [](FoamMesh& m) { std::swap(m.faces[FaceId{5}].back, m.faces[FaceId{5}].front); }},
        {"belongs to no face", [](FoamMesh& m) { m.add_vertex({{9.0, 9.0, 9.0}}); }, false},
        {"region 3 is closed but has no face", [](FoamMesh& m) { m.regions.push_back({RegionKind::kClosed, 1.0}); }, false},
        {"region 2, which is gone", [](FoamMesh& m) { m.regions[RegionId{2}].kind = RegionKind::kGone; }, false},
        {"region 1 has the target volume -1", [](FoamMesh& m) { m.regions[RegionId{1}].target_volume = -1.0; }, false},
        {"cut each other", [](FoamMesh& m) { m.position[VertexId{40}] = -3.0 * m.position[VertexId{40}]; }},
        {"turned inside out",
         [](FoamMesh& m) {
             for (Vec3& x : m.position) x[0] = -x[0];
         },
         false},
    };
    for (const Damage& damage : damages) {
        FoamMesh mesh = sound();
        damage.make(mesh);
        const auto found = faults(mesh);
        ASSERT_FALSE(found.empty()) << damage.says;
        EXPECT_NE(found[0].find(damage.says), std::string::npos) << damage.says << " | " << found[0];
        if (damage.brute_force_sees) { EXPECT_FALSE(test::faults(mesh).empty()) << damage.says; }
        EXPECT_THROW(require_sound(mesh, "mesh"), InputError);
    }
}

TEST(Check, StopsAtTheLongestList) {
    FoamMesh mesh = sound();
    for (Face& face : mesh.faces) face.back = face.front;
    EXPECT_EQ(faults(mesh, {.intersections = true, .longest_list = 5}).size(), 5U);
}

TEST(Subdivide, KeepsTheMeshSoundAndRimsOnTheirRing) {
    const FoamMesh coarse = disk({}, {{0.0, 0.0, 1.0}}, 1.0, 0.3);
    const EdgeFaces edges = edge_faces(coarse);
    const FoamMesh fine = subdivide(coarse, edges, edge_middles(coarse, edges));
    EXPECT_EQ(fine.faces.size(), 4 * coarse.faces.size());
    EXPECT_TRUE(faults(fine).empty());
    for (const VertexId v : fine.position.ids())
        if (fine.on_wire[v] != 0) { EXPECT_NEAR(norm(fine.position[v]), 1.0, 1e-14); }
    const FoamMesh cell = periodic_foam(PeriodicFoam::kKelvin, 1.0, 0.5);
    const EdgeFaces cell_edges = edge_faces(cell);
    EXPECT_TRUE(faults(subdivide(cell, cell_edges, edge_middles(cell, cell_edges))).empty());
}

TEST(Join, PutsSeparateFilmsTogether) {
    FoamMesh mesh = sound();
    FoamMesh other = sound();
    for (Vec3& x : other.position) x[2] += 5.0;
    const std::size_t faces = mesh.faces.size();
    join(mesh, other);
    EXPECT_EQ(mesh.faces.size(), 2 * faces);
    EXPECT_EQ(mesh.regions.size(), 5U);
    EXPECT_TRUE(faults(mesh).empty());
    EXPECT_THROW(join(mesh, periodic_foam(PeriodicFoam::kKelvin, 1.0, 0.5)), InputError);
}

TEST(PlateauFaults, SeesCrossingsAndNothingElse) {
    const auto faults_of = [](const FoamMesh& mesh) { return plateau_faults(mesh, edge_faces(mesh)); };
    EXPECT_TRUE(faults_of(sound()).none());
    EXPECT_TRUE(faults_of(frame_cone(FrameShape::kTetrahedron, {}, 1.0, 0.25)).none());
    EXPECT_TRUE(faults_of(periodic_foam(PeriodicFoam::kWeairePhelan, 1.0, 0.3)).none());
    EXPECT_EQ(faults_of(frame_cone(FrameShape::kOctahedron, {}, 1.0, 0.5)).edges.size(), 12U);
    EXPECT_EQ(faults_of(frame_cone(FrameShape::kCube, {}, 1.0, 0.5)).vertices.size(), 1U);
}

}  // namespace
}  // namespace lamella::mesh
