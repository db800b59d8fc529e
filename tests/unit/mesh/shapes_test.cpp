// Every shape is sound, and its areas and volumes are those of the closed forms, to second order in the edge length.

#include "lamella/core/error.h"
#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"
#include "relaxation.h"

#include "lamella/mesh/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lamella::mesh {
namespace {

constexpr double kPi = 3.14159265358979323846;

double area_of(const FoamMesh& mesh) {
    double area = 0.0;
    for (const FaceId f : mesh.faces.ids())
        area += 0.5 * norm(cross(mesh.corner(f, 1) - mesh.corner(f, 0), mesh.corner(f, 2) - mesh.corner(f, 0)));
    return area;
}

void expect_sound(const FoamMesh& mesh) {
    for (const std::string& fault : test::faults(mesh)) ADD_FAILURE() << fault;
}

/// Errors of area(edge) against the exact one at h and h / 2, relative; flat shapes have none.
void expect_second_order(const std::function<FoamMesh(double)>& make, double exact, double h, double least_angle_deg) {
    const FoamMesh coarse = make(h), fine = make(0.5 * h);
    expect_sound(coarse);
    const double e1 = std::abs(area_of(coarse) / exact - 1.0), e2 = std::abs(area_of(fine) / exact - 1.0);
    EXPECT_LT(e1, 0.02);
    EXPECT_GT(e1 / e2, 3.0) << e1 << " " << e2;
    EXPECT_GT(min_angle(fine) * 180.0 / kPi, least_angle_deg);
    EXPECT_NEAR(edge_lengths(fine).mean, 0.5 * h, 0.15 * h);
}

TEST(Spheres, ConvergeToTheBallAtSecondOrder) {
    expect_second_order([](double h) { return spheres({{{{0.1, 0.2, 0.3}}, 1.0}}, h); }, 4.0 * kPi, 0.2, 45.0);
    const FoamMesh mesh = spheres({{{}, 1.0}, {{{3.0, 0.0, 0.0}}, 0.5}}, 0.1);
    EXPECT_NEAR(region_volumes(mesh)[RegionId{1}] / (4.0 / 3.0 * kPi), 1.0, 5e-3);
    EXPECT_NEAR(region_volumes(mesh)[RegionId{2}] / (4.0 / 3.0 * kPi / 8.0), 1.0, 2e-2);
    EXPECT_THROW(spheres({{{}, 1.0}, {{{1.9, 0.0, 0.0}}, 1.0}}, 0.1), InputError);
    EXPECT_THROW(spheres({{{}, -1.0}}, 0.1), InputError);
    EXPECT_THROW(spheres({{{}, 1.0}}, 1e-6), InputError);
}

struct Reference {
    double volume2, area, radius1, radius2, circle, distance, partition;
};

TEST(DoubleBubble, IsThatOfTheReferenceValues) {
    // shared reference values, analytic: volumes 1 and 1, 0.5, 0.125.
    for (const Reference& r :
         {Reference{1.0, 9.139421678069333, 0.6564966812284644, 0.6564966812284644, 0.5685428034440247,
                    0.6564966812284644, 1.015491297563259},
          Reference{0.5, 7.467736721795792, 0.6434279223045756, 0.5347193609925234, 0.4994709048744302,
                    0.5965491754767464, 0.7886784225720423},
          Reference{0.125, 5.818895160521264, 0.628427749377666, 0.3588253427634048, 0.3576258647758249,
                    0.546059758840255, 0.4220613268710251}}) {
        const DoubleBubble b = double_bubble_of_volumes(1.0, r.volume2);
        EXPECT_NEAR(b.area(), r.area, 1e-12);
        EXPECT_NEAR(b.radius1, r.radius1, 1e-12);
        EXPECT_NEAR(b.radius2, r.radius2, 1e-12);
        EXPECT_NEAR(b.circle_radius, r.circle, 1e-12);
        EXPECT_NEAR(b.center_distance, r.distance, 1e-12);
        EXPECT_NEAR(b.partition_area, r.partition, 1e-12);
        EXPECT_NEAR(b.volume1, 1.0, 1e-12);
        EXPECT_NEAR(b.volume2, r.volume2, 1e-12);
        const DoubleBubble mirrored = double_bubble_of_volumes(r.volume2, 1.0);
        EXPECT_NEAR(mirrored.area(), r.area, 1e-12);
        EXPECT_NEAR(mirrored.volume1, r.volume2, 1e-12);
    }
    // Given radii of 5 and 2 cm.
    const DoubleBubble b = double_bubble_of_radii(0.05, 0.02);
    EXPECT_NEAR(b.area(), 0.0337231938913647, 1e-15);
    EXPECT_NEAR(b.volume1, 0.000516788619283899, 1e-17);
    EXPECT_NEAR(b.volume2, 1.81058448955381e-05, 1e-18);
}

TEST(DoubleBubble, MeshConvergesAtSecondOrder) {
    for (const double volume2 : {1.0, 0.3, 3.0}) {
        const DoubleBubble b = double_bubble_of_volumes(1.0, volume2);
        expect_second_order([&](double h) { return double_bubble(b, h); }, b.area(), 0.16, 20.0);
        const auto volumes = region_volumes(double_bubble(b, 0.04));
        EXPECT_NEAR(volumes[RegionId{1}] / b.volume1, 1.0, 6e-3);
        EXPECT_NEAR(volumes[RegionId{2}] / b.volume2, 1.0, 6e-3);
    }
}

TEST(TripleAndQuadrupleBubble, AreSoundClustersOfEqualVolume) {
    for (const FoamMesh& mesh : {triple_bubble(1.0, 0.2), quadruple_bubble(1.0, 0.2)}) {
        expect_sound(mesh);
        for (const RegionId r : mesh.regions.ids())
            if (r != kOutside) { EXPECT_EQ(mesh.regions[r].target_volume, 1.0); }
        // The cells are sampled on a lattice of this spacing, which does not have the cluster's symmetry.
        const auto volumes = region_volumes(mesh);
        EXPECT_NEAR(volumes[RegionId{1}] / volumes[RegionId{2}], 1.0, 0.2);
    }
}

TEST(WireFilms, HaveTheAreasOfTheirShapes) {
    const Vec3 center{{0.1, -0.2, 0.3}}, axis{{1.0, 2.0, -0.5}};
    expect_second_order([&](double h) { return disk(center, axis, 1.0, h); }, kPi, 0.2, 30.0);
    expect_second_order([&](double h) { return hemisphere(center, axis, 1.0, h); }, 2.0 * kPi, 0.2, 25.0);
    expect_second_order([&](double h) { return ball_in_ring(center, axis, 1.0, h); }, 4.0 * kPi, 0.2, 25.0);
    const auto volumes = region_volumes(ball_in_ring(center, axis, 1.0, 0.1));
    EXPECT_NEAR(volumes[RegionId{1}] / (4.0 / 3.0 * kPi), 1.0, 0.01);
    expect_second_order([&](double h) { return cylinder(center, axis, 1.0, 0.7, h); }, 2.0 * kPi * 0.7, 0.2, 30.0);
    const FoamMesh plate = rectangle(center, {{2.0, 0.0, 0.0}}, {{0.0, 0.0, 1.0}}, 0.13);
    expect_sound(plate);
    EXPECT_NEAR(area_of(plate), 2.0, 1e-13);
    EXPECT_THROW(rectangle(center, {{2.0, 0.0, 0.0}}, {{0.5, 0.0, 1.0}}, 0.1), InputError);
}

TEST(Catenoid, HasTheNeckAndAreaOfTheClosedForm) {
    struct Case {
        double separation, neck, area;
        CatenoidBranch branch;
    };
    for (const Case& c : {Case{0.4, 0.9795106030753393, 2.496276337589494, CatenoidBranch::kStable},
                          Case{0.8, 0.910737994273788, 4.883793201931147, CatenoidBranch::kStable},
                          Case{1.3, 0.6416076017778053, 7.439781377393902, CatenoidBranch::kStable},
                          Case{1.3, 0.0, 7.459018678013384, CatenoidBranch::kUnstable},
                          Case{0.8, 0.0, 6.601303526008196, CatenoidBranch::kUnstable}}) {
        if (c.neck > 0.0) { EXPECT_NEAR(catenoid_neck(1.0, c.separation, c.branch), c.neck, 1e-13); }
        expect_second_order([&](double h) { return catenoid({}, {{0.0, 0.0, 1.0}}, 1.0, c.separation, h, c.branch); },
                            c.area, 0.12, 20.0);
    }
    EXPECT_NO_THROW(catenoid_neck(1.0, 1.3254868, CatenoidBranch::kStable));
    EXPECT_THROW(catenoid_neck(1.0, 1.3255, CatenoidBranch::kStable), InputError);
}

TEST(FrameCone, IsFlatAndSound) {
    for (const auto& [shape, area] : {std::pair{FrameShape::kTetrahedron, 1.0606601717798214},
                                      std::pair{FrameShape::kOctahedron, 3.0},
                                      std::pair{FrameShape::kCube, 4.242640687119286}}) {
        const FoamMesh mesh = frame_cone(shape, {{0.5, 0.0, 0.0}}, 1.0, 0.25);
        expect_sound(mesh);
        EXPECT_NEAR(area_of(mesh), area, 1e-13);
    }
}

}  // namespace
}  // namespace lamella::mesh
