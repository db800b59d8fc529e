// What a run keeps, and that it goes on: volumes, energy, impulse, sound meshes through merging, bursting, pinching.

#include "course.h"

#include <map>

namespace lamella::vortex_sheet {
namespace {

TEST(Course, OfAJitteredSphereKeepsItsEnergyOnFixedTriangles) {
    const double edge = 0.3;
    Options options;
    options.remeshing = false;
    const auto solver = started(unit_problem(uneven_sphere(edge), edge), options);
    const Course course = run(*solver, 40.0);
    report("sphere, fixed", course);
    EXPECT_LT(course.energy_spread(), 0.05 * course.largest_kinetic);
    EXPECT_LT(course.volume_error, 1e-6);
    EXPECT_LT(course.impulse, 1e-10);
}

TEST(Course, OfAJitteredSphereDoesNotBlowUpWithRemeshing) {
    const double edge = 0.3;
    const auto solver = started(unit_problem(uneven_sphere(edge), edge), {});
    const Course course = run(*solver, 40.0);
    report("sphere, remeshed", course);
    EXPECT_LT(course.largest_energy, 1.01 * course.least_energy);
    EXPECT_LT(course.volume_error, 1e-6);
    EXPECT_LT(course.impulse, 1e-10);
}

TEST(Course, OfAnUnevenDoubleBubbleDoesNotBlowUpWithRemeshing) {
    const double edge = 0.3;
    const auto solver = started(unit_problem(uneven_double_bubble(edge), edge), {});
    const Course course = run(*solver, 35.0);
    report("double bubble", course);
    EXPECT_LT(course.largest_energy, 1.01 * course.least_energy);
    EXPECT_LT(course.volume_error, 1e-6);
    EXPECT_LT(course.impulse, 1e-10);
}

TEST(Course, KeepsVolumesWithoutCorrection) {
    mesh::FoamMesh sphere = mesh::spheres({{Vec3{}, 1.0}}, 0.2);
    mesh::FoamMesh bubbles = mesh::double_bubble(mesh::double_bubble_of_radii(1.0, 0.8), 0.25);
    for (mesh::FoamMesh* mesh : {&sphere, &bubbles}) {
        for (Vec3& x : mesh->position) x[0] *= 0.9;
        take_volumes_as_targets(*mesh);
        Options options;
        options.volume_projection = false;
        const auto solver = started(unit_problem(std::move(*mesh), mesh == &sphere ? 0.2 : 0.25), options);
        const Course course = run(*solver, 4.0);
        report("no projection", course);
        EXPECT_LT(course.volume_error, 1e-6);
    }
}

TEST(Course, OfTwoBubblesThatMeetIsADoubleBubble) {
    const auto solver = solver_of(R"(
[[bubble]]
center = [-1.15, 0.0, 0.0]
radius = 1.0
velocity = [0.6, 0.0, 0.0]
[[bubble]]
center = [1.15, 0.0, 0.0]
radius = 1.0
velocity = [-0.6, 0.0, 0.0]
[resolution]
edge_length = 0.25
[time]
end = 1.0)");
    solver->start({});
    const double at_start = scalar(*solver, "energy");
    const Course course = run(*solver, 4.0);
    report("two bubbles meet", course);
    bool merged = false;
    for (const sim::Event& e : solver->take_events()) merged |= e.kind == "merge";
    EXPECT_TRUE(merged);
    EXPECT_EQ(scalar(*solver, "bubbles"), 2.0);
    EXPECT_EQ(solver->topology().clusters, 1U);
    EXPECT_LT(course.volume_error, 1e-6);
    // 49.95 to 52.92 measured: the energy that the two films lose where they become one, and never more than at the start.
    EXPECT_LT(course.largest_energy, 1.001 * at_start);
}

TEST(Course, OfAClusterThatIsPoppedEndsWithOneBubble) {
    const auto solver = solver_of(R"(
seed = 2
[foam]
count = 10
volume = 1.0
sizes = "normal"
deviation = 0.2
[[event]]
time = 1.0
region = 0
repeat = 9
interval = 0.5
[resolution]
edge_length = 0.25
[time]
end = 1.0
[vortex_sheet]
damping = 3.0)");
    solver->start({});
    const Course course = run(*solver, 6.0);
    report("cluster", course);
    std::map<std::string, int> events;
    for (const sim::Event& e : solver->take_events()) ++events[e.kind];
    for (const auto& [kind, count] : events) std::printf("   %s %d\n", kind.c_str(), count);
    EXPECT_EQ(events["pop"], 9);
    EXPECT_EQ(events["absorb"], 0);
    EXPECT_EQ(scalar(*solver, "bubbles"), 1.0);
}

}  // namespace
}  // namespace lamella::vortex_sheet
