#include "films.h"

#include <gtest/gtest.h>

namespace lamella::vortex_sheet {
namespace {

using mesh::VertexId;

TEST(SheetTopology, TellsRimsFromWiresThatRunThroughAFilm) {
    const mesh::FoamMesh disk = mesh::disk({}, {{0, 0, 1}}, 1.0, 0.25);
    const SheetTopology of_disk = sheet_topology(disk);
    for (const VertexId v : disk.position.ids())
        EXPECT_EQ(of_disk.hold[v], disk.on_wire[v] != 0 ? Hold::kRim : Hold::kFree);

    mesh::FoamMesh sphere = mesh::spheres({{Vec3{}, 1.0}}, 0.4);
    sphere.on_wire[VertexId{5}] = 1;
    const SheetTopology of_sphere = sheet_topology(sphere);
    for (const VertexId v : sphere.position.ids())
        EXPECT_EQ(of_sphere.hold[v], v == VertexId{5} ? Hold::kPinned : Hold::kFree);
}

TEST(SheetTopology, CountsConnectedFilms) {
    EXPECT_EQ(sheet_topology(mesh::double_bubble(mesh::double_bubble_of_volumes(1, 1), 0.3)).clusters, 1U);
    const mesh::FoamMesh three = mesh::spheres({{Vec3{}, 1.0}, {{{3, 0, 0}}, 0.5}, {{{0, 4, 0}}, 1.0}}, 0.3);
    const SheetTopology topology = sheet_topology(three);
    EXPECT_EQ(topology.clusters, 3U);
    for (const mesh::Face& face : three.faces) EXPECT_EQ(topology.cluster[face.vertices[0]], topology.cluster[face.vertices[2]]);
}

TEST(FixGauge, KeepsEveryJumpAndMakesVerticesSumToZero) {
    const mesh::FoamMesh mesh = mesh::quadruple_bubble(1.0, 0.3);
    const SheetTopology topology = sheet_topology(mesh);
    const Circulation before = random_values(1, topology.size());
    Circulation after = before;
    fix_gauge(topology, after);
    for (const mesh::FaceId f : mesh.faces.ids())
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(jump(topology, after, f, k), jump(topology, before, f, k), 1e-15);
    for (const VertexId v : mesh.position.ids()) {
        double sum = 0.0;
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i) sum += after[i];
        EXPECT_NEAR(sum, 0.0, 1e-15);
    }
}

}  // namespace
}  // namespace lamella::vortex_sheet
