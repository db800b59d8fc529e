// Resting films against closed forms and the Surface Evolver's values (film tension 1, unit volumes). Every case is a
// shipped scene, so these tests also keep the scenes alive.

#include "lamella/mesh/check.h"
#include "lamella/scene/scene.h"
#include "lamella/scene/shipped.h"
#include "lamella/solvers/equilibrium/equilibrium_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace lamella::equilibrium {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

struct Rest {
    RestAnswer answer;
    std::size_t faces = 0;
    std::int64_t steps = 0;
    double volume_error = 0.0;
    double residual = 0.0;
};

Rest rest_of(const std::string& name, const std::vector<std::string>& overrides = {}) {
    const sim::SolverRegistry registry = scene::all_solvers();
    const scene::Scene scene =
        scene::load_scene(scene::resolve_scene_path("equilibrium/" + name), overrides, registry);
    const auto solver = scene::create_solver(scene, registry);
    auto& equilibrium = dynamic_cast<EquilibriumSolver&>(*solver);
    equilibrium.start({});
    while (!equilibrium.stop_reason()) equilibrium.advance(1.0);
    Rest rest{*equilibrium.answer(), equilibrium.relaxation().mesh().faces.size(), equilibrium.step(), 0.0,
              equilibrium.relaxation().residual()};
    for (const sim::Scalar& s : equilibrium.scalars())
        if (s.name == "volume_error") rest.volume_error = s.value;
    if (!equilibrium.relaxation().mesh().periodic())
        for (const std::string& fault : mesh::faults(equilibrium.relaxation().mesh())) ADD_FAILURE() << name << fault;
    return rest;
}

struct Case {
    std::string scene;
    double area;
    double quadratic_error;  ///< allowed, relative: 2e-6 at about 1,000 faces, 1e-7 at 4,600
    std::vector<double> pressure = {};
    double pressure_error = 0.0;
};

void expect_rest(const Case& c, bool stable = true) {
    const Rest rest = rest_of(c.scene);
    const RestAnswer& a = rest.answer;
    const auto faces = static_cast<double>(rest.faces);
    std::printf("%-28s F %6.0f steps %3d  area %+.1e polyhedral %+.1e  films %.3f %.3f lines %.3f deg\n", c.scene.c_str(),
                faces, static_cast<int>(rest.steps), a.area / c.area - 1.0, a.polyhedral_area / c.area - 1.0,
                a.film_angles.mean / kDegree, a.film_angles.largest / kDegree, a.junction_angles.largest / kDegree);
    EXPECT_NEAR(a.area / c.area, 1.0, c.quadratic_error) << c.scene;
    EXPECT_NEAR(a.polyhedral_area / c.area, 1.0, 5.0 / faces + 1e-4) << c.scene;
    EXPECT_LT(rest.residual, 1e-8) << c.scene;
    EXPECT_LT(rest.volume_error, 1e-9) << c.scene;
    EXPECT_LT(rest.steps, 45) << c.scene;
    EXPECT_EQ(a.stable(), stable) << c.scene;
    for (std::size_t k = 0; k < c.pressure.size(); ++k)
        EXPECT_NEAR(a.pressure[k + 1] / c.pressure[k], 1.0, c.pressure_error) << c.scene;
}

TEST(EquilibriumReference, DoubleBubbles) {
    for (const char* size : {"-small", ""}) {
        const bool fine = std::string(size).empty();
        const double area = fine ? 1e-7 : 2e-6, pressure = fine ? 1e-5 : 1e-4;
        const std::string s = size;
        expect_rest({"double-bubble-1" + s, 9.139421678069333, area, {3.046473892689778, 3.046473892689778}, pressure});
        expect_rest({"double-bubble-0.5" + s, 7.467736721795792, area, {3.108351270856524, 3.740279754014676}, pressure});
        expect_rest(
            {"double-bubble-0.125" + s, 5.818895160521264, area, {3.182545649807168, 5.57374232432273}, pressure});
    }
}

TEST(EquilibriumReference, PartitionCurvature) {
    // The jump across the partition is twice its curvature, 1/R2 - 1/R1 (film tension 1).
    for (const auto& [scene, curvature] :
         {std::pair{"double-bubble-0.5", 0.315964241579076}, std::pair{"double-bubble-0.125", 1.195598337257781}}) {
        const RestAnswer a = rest_of(scene).answer;
        EXPECT_NEAR((a.pressure[2] - a.pressure[1]) / (2.0 * curvature), 1.0, 1e-3) << scene;
    }
}

TEST(EquilibriumReference, DoubleBubbleFromTouchingSpheres) {
    // Volumes of 1 l, tension irrelevant for the area: the same shape at a tenth of the size.
    expect_rest({"double-bubble-small", 0.09139421678069333, 2e-6});
}

TEST(EquilibriumReference, TripleAndQuadruple) {
    expect_rest({"triple-bubble-small", 13.1281682444334, 2e-6, {2.91737072098521}, 1e-4});
    expect_rest({"quadruple-bubble-small", 16.8965576436161, 2e-6, {2.81609294060269}, 1e-4});
    expect_rest({"triple-bubble", 13.1281682444334, 1e-7, {2.91737072098521}, 1e-5});
    expect_rest({"quadruple-bubble", 16.8965576436161, 1e-7, {2.81609294060269}, 1e-5});
}

TEST(EquilibriumReference, AnglesOfPlateauOnCurvedPatches) {
    for (const char* scene : {"double-bubble-1", "triple-bubble", "quadruple-bubble"}) {
        const RestAnswer a = rest_of(scene).answer;
        EXPECT_LT(a.film_angles.mean, 0.1 * kDegree) << scene;
        EXPECT_LT(a.film_angles.largest, 0.3 * kDegree) << scene;
        EXPECT_LT(a.junction_angles.mean, 0.3 * kDegree) << scene;
        EXPECT_LT(a.junction_angles.largest, 0.3 * kDegree) << scene;
    }
}

TEST(EquilibriumReference, ClustersFromRandomHeaps) {
    expect_rest({"cluster-5-small", 20.632224444053, 2e-6});
    expect_rest({"cluster-6-small", 24.228995845132, 3e-6});
    expect_rest({"cluster-8-small", 31.4325184082, 3e-6});
    expect_rest({"cluster-10-small", 38.454847587224, 2e-6});
    expect_rest({"cluster-13-small", 48.386854577245, 2e-6});
}

TEST(EquilibriumReference, Catenoids) {
    expect_rest({"catenoid-0.4-small", 2.496276337589494, 2e-6});
    expect_rest({"catenoid-0.8-small", 4.883793201931147, 2e-6});
    expect_rest({"catenoid-1.3-small", 7.439781377393902, 2e-6});
    expect_rest({"catenoid-0.4", 2.496276337589494, 1e-7});
    expect_rest({"catenoid-0.8", 4.883793201931147, 1e-7});
    expect_rest({"catenoid-1.3", 7.439781377393902, 1e-7});
}

TEST(EquilibriumReference, CatenoidBeyondItsLimitPinchesIntoTwoDisks) {
    const Rest rest = rest_of("catenoid-collapse-small");
    // The rings are polygons of 39 sides: disks of that many sides.
    constexpr double kDisks = 2.0 * 3.14159265358979323846 * 0.05 * 0.05;
    EXPECT_NEAR(rest.answer.area / kDisks, 1.0, 1e-4);
    EXPECT_TRUE(rest.answer.stable());
}

TEST(EquilibriumReference, UnstableCatenoidHasOneUnstableMode) {
    const Rest rest = rest_of("catenoid-unstable-small");
    EXPECT_EQ(rest.answer.index, 1);
    EXPECT_NEAR(rest.answer.lowest_eigenvalue, -3.95, 0.1);  // -3.9 in an independent prototype
    EXPECT_FALSE(rest.answer.stable());
}

TEST(EquilibriumReference, WireFrames) {
    expect_rest({"frame-tetrahedron-small", 1.0606601717798214, 1e-9});
    expect_rest({"frame-octahedron-small", 2.8284271247461903, 1e-9});
    const Rest cone = rest_of("frame-octahedron-cone-small");
    EXPECT_NEAR(cone.answer.area, 3.0, 1e-9);
    EXPECT_EQ(cone.answer.index, 0);  // fixed connectivity cannot see it
    EXPECT_GT(cone.answer.irregular_vertices, 0U);
    EXPECT_FALSE(cone.answer.stable());
    // The cube's cone (4.24264) parts into the film with a square in its middle.
    const Rest cube = rest_of("frame-cube-small");
    EXPECT_LT(cube.answer.area, 4.2396);
    EXPECT_TRUE(cube.answer.stable());
}

TEST(EquilibriumReference, FoamsThatFillSpace) {
    // Twice the area over the number of bubbles: 5.306276163, 5.288339016.
    expect_rest({"kelvin-small", 5.3062761631070705, 2e-6});
    expect_rest({"kelvin", 5.3062761631070705, 2e-7});
    expect_rest({"weaire-phelan-small", 4.0 * 5.28833901559975, 2e-6});
    expect_rest({"weaire-phelan", 4.0 * 5.28833901559975, 1e-7});
}

TEST(EquilibriumReference, SphereHasTheEigenvalueOfItsSecondHarmonic) {
    const RestAnswer a =
        rest_of("double-bubble-small", {"film=[]", "bubble=[{center=[0,0,0],radius=1.0}]", "resolution.edge_length=0.15"})
            .answer;
    EXPECT_NEAR(a.lowest_eigenvalue, 4.0, 0.03);
    EXPECT_NEAR(a.area / (4.0 * 3.14159265358979323846), 1.0, 1e-6);
}

}  // namespace
}  // namespace lamella::equilibrium
