#include "lamella/mesh/label_sides.h"

#include "lamella/core/error.h"
#include "lamella/mesh/join.h"
#include "lamella/mesh/shapes/periodic_foam.h"
#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

namespace lamella::mesh {
namespace {

/// The mesh without labels, every third face turned over.
FoamMesh stripped(FoamMesh mesh) {
    for (const FaceId f : mesh.faces.ids()) {
        Face& face = mesh.faces[f];
        face.back = face.front = kNoRegion;
        if (index(f) % 3 != 0) continue;
        std::swap(face.vertices[1], face.vertices[2]);
        if (mesh.periodic()) std::swap(mesh.images[f][1], mesh.images[f][2]);
    }
    mesh.regions.clear();
    mesh.regions.push_back({RegionKind::kOpen, 0.0});
    return mesh;
}

/// Whether both label the same sides alike, up to the numbers of the regions.
void expect_same_partition(const FoamMesh& found, const FoamMesh& expected) {
    std::map<RegionId, RegionId> name;
    std::set<RegionId> used;
    for (const FaceId f : expected.faces.ids()) {
        const bool turned = found.faces[f].vertices != expected.faces[f].vertices;
        for (const auto& [theirs, ours] :
             {std::pair{expected.faces[f].back, turned ? found.faces[f].front : found.faces[f].back},
              std::pair{expected.faces[f].front, turned ? found.faces[f].back : found.faces[f].front}}) {
            const auto [it, fresh] = name.try_emplace(theirs, ours);
            ASSERT_EQ(it->second, ours) << "face " << index(f);
            if (fresh) {
                EXPECT_TRUE(used.insert(ours).second) << "two regions became " << index(ours);
            }
        }
    }
    if (name.contains(kOutside)) {
        EXPECT_EQ(name[kOutside], kOutside);
    }
}

TEST(LabelSides, FindsTheRegionsOfClustersAndWireFilms) {
    for (const FoamMesh& mesh :
         {quadruple_bubble(1.0, 0.4), double_bubble(double_bubble_of_volumes(1.0, 3.0), 0.4),
          catenoid({}, {{0, 0, 1}}, 1.0, 0.8, 0.3), hemisphere({{1, 2, 3}}, {{1, 1, 0}}, 1.0, 0.4)}) {
        FoamMesh found = stripped(mesh);
        label_sides(found, edge_faces(found));
        expect_same_partition(found, mesh);
    }
}

TEST(LabelSides, GivesEveryCellOfAFrameOneRegion) {
    FoamMesh found = stripped(frame_cone(FrameShape::kOctahedron, {}, 1.0, 0.4));
    label_sides(found, edge_faces(found));
    EXPECT_EQ(found.regions.size(), 8U);  // one of the eight cells is the outside
}

TEST(LabelSides, FindsTheCellsOfAPeriodicFoam) {
    const FoamMesh foam = periodic_foam(PeriodicFoam::kWeairePhelan, 1.0, 0.5);
    FoamMesh found = stripped(foam);
    label_sides(found, edge_faces(found));
    EXPECT_EQ(found.regions.size(), foam.regions.size() - 1);  // one of the eight cells takes the place of the outside
}

TEST(LabelSides, KeepsLabelsThatAreThere) {
    const FoamMesh cluster = triple_bubble(1.0, 0.4);
    FoamMesh found = cluster;
    for (Face& face : found.faces) {
        if (face.back == kOutside) face.back = kNoRegion;
        if (face.front == kOutside) face.front = kNoRegion;
    }
    label_sides(found, edge_faces(found));
    EXPECT_EQ(found, cluster);
}

std::string complaint(FoamMesh mesh) {
    try {
        label_sides(mesh, edge_faces(mesh));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no complaint";
}

TEST(LabelSides, RefusesLabelsThatContradictEachOther) {
    FoamMesh mesh = spheres({{{}, 1.0}}, 0.5);
    mesh.regions.push_back({RegionKind::kOpen, 0.0});
    mesh.faces[FaceId{5}].back = RegionId{2};
    EXPECT_NE(complaint(mesh).find("faces 0 and 5 look at the same gas, but one names region 1 there, the other region 2"),
              std::string::npos)
        << complaint(mesh);
}

TEST(LabelSides, RefusesFilmsInsideOthersWithoutLabels) {
    FoamMesh mesh = spheres({{{}, 1.0}}, 0.5);
    join(mesh, spheres({{{{0.1, 0, 0}}, 0.3}}, 0.2));
    EXPECT_NE(complaint(stripped(mesh)).find("lies inside region 1, behind face 0"), std::string::npos)
        << complaint(stripped(mesh));
    FoamMesh beside = spheres({{{}, 1.0}}, 0.5);
    join(beside, spheres({{{{0.9, 0.9, 0.9}}, 0.2}}, 0.2));  // in the box around the first, not in it
    EXPECT_EQ(complaint(stripped(beside)), "no complaint");
}

TEST(ClosedIn, TellsBubblesFromAirBesideAFilm) {
    FoamMesh mesh = spheres({{{}, 1.0}}, 0.5);
    join(mesh, disk({{3, 0, 0}}, {{0, 0, 1}}, 1.0, 0.5));
    EXPECT_EQ(closed_in(mesh, edge_faces(mesh)).values(), (std::vector<std::uint8_t>{0, 1, 0}));
}

}  // namespace
}  // namespace lamella::mesh
