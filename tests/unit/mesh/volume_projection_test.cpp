#include "lamella/mesh/volume_projection.h"

#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/volume.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella::mesh {
namespace {

double worst_error(const FoamMesh& mesh) {
    const auto volume = region_volumes(mesh);
    double worst = 0.0;
    for (const RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == RegionKind::kClosed)
            worst = std::max(worst, std::abs(volume[r] / mesh.regions[r].target_volume - 1.0));
    return worst;
}
void apply(FoamMesh& mesh, const VolumeProjection& projection) {
    for (const VertexId v : mesh.position.ids()) mesh.position[v] += projection.displacement[v];
}
void take_volumes_as_targets(FoamMesh& mesh) {
    for (const RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == RegionKind::kClosed) mesh.regions[r].target_volume = region_volumes(mesh)[r];
}

TEST(VolumeProjection, SquaresTheErrorWithEachRound) {
    for (FoamMesh mesh : {double_bubble(double_bubble_of_volumes(1.0, 0.3), 0.2), quadruple_bubble(1.0, 0.25)}) {
        take_volumes_as_targets(mesh);
        for (Vec3& x : mesh.position) x *= 1.001;
        const double before = worst_error(mesh);
        const VolumeProjection once = volume_projection(mesh, 1), twice = volume_projection(mesh, 2);
        EXPECT_NEAR(once.error, before, 1e-12);
        FoamMesh a = mesh, b = mesh;
        apply(a, once);
        apply(b, twice);
        EXPECT_LT(worst_error(a), 2.0 * before * before);
        EXPECT_LT(worst_error(b), 1e-9);
    }
}

TEST(VolumeProjection, MovesAnEvenBubbleEvenly) {
    FoamMesh mesh = spheres({{Vec3{}, 1.0}}, 0.2);
    take_volumes_as_targets(mesh);
    for (Vec3& x : mesh.position) x *= 0.999;
    apply(mesh, volume_projection(mesh, 2));
    for (const Vec3& x : mesh.position) EXPECT_NEAR(norm(x), 1.0, 2e-5);  // 0.001 h^2 / R^2 of unevenness
}

TEST(VolumeProjection, LeavesVerticesOnWiresAndAMeshWithRightVolumes) {
    FoamMesh mesh = spheres({{Vec3{}, 1.0}}, 0.3);
    take_volumes_as_targets(mesh);
    for (const Vec3& d : volume_projection(mesh).displacement) EXPECT_LT(norm(d), 1e-14);
    for (const VertexId v : mesh.position.ids()) mesh.on_wire[v] = mesh.position[v][0] > 0.7;
    for (Vec3& x : mesh.position) x *= 0.999;
    const VolumeProjection projection = volume_projection(mesh, 2);
    for (const VertexId v : mesh.position.ids())
        if (mesh.on_wire[v] != 0) { EXPECT_EQ(projection.displacement[v], Vec3{}); }
    apply(mesh, projection);
    EXPECT_LT(worst_error(mesh), 1e-9);
}

TEST(VolumeProjection, TakesALargeErrorInPortions) {
    FoamMesh mesh = spheres({{Vec3{}, 1.0}}, 0.3);
    take_volumes_as_targets(mesh);
    mesh.regions[RegionId{1}].target_volume *= 1.5;
    const double before = region_volumes(mesh)[RegionId{1}];
    apply(mesh, volume_projection(mesh, 1, 0.03));
    EXPECT_NEAR((region_volumes(mesh)[RegionId{1}] - before) / mesh.regions[RegionId{1}].target_volume, 0.03, 0.001);
}

}  // namespace
}  // namespace lamella::mesh
