// What a run keeps, and that it goes on: volumes, energy, impulse, sound meshes through merging, bursting, pinching.

#include "sheets.h"

#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"

#include <cstdio>
#include <map>

namespace lamella::vortex_sheet {
namespace {

void report(const char* name, const Course& c) {
    std::printf("%-22s steps %5d  volume %.1e  energy %.5f to %.5f, spread/kinetic %.3f, /total %.1e  impulse %.1e\n", name,
                static_cast<int>(c.steps), c.volume_error, c.least_energy, c.largest_energy,
                c.energy_spread() / c.largest_kinetic, c.energy_spread() / c.largest_energy, c.impulse);
}

mesh::FoamMesh jittered(mesh::FoamMesh mesh, double edge, double share) {
    for (const mesh::VertexId v : mesh.position.ids()) {
        Vec3& x = mesh.position[v];
        const auto i = static_cast<double>(index(v));
        const Vec3 kick{{std::sin(12.9898 * i), std::sin(78.233 * i), std::sin(37.719 * i)}};
        x += share * edge * (kick - dot(kick, x) / dot(x, x) * x);
    }
    return mesh;
}
void take_volumes_as_targets(mesh::FoamMesh& mesh) {
    const auto volume = mesh::region_volumes(mesh);
    for (const mesh::RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == mesh::RegionKind::kClosed) mesh.regions[r].target_volume = volume[r];
}

TEST(Course, OfAJitteredSphereKeepsItsEnergyOnFixedTriangles) {
    const double edge = 0.3;
    mesh::FoamMesh sphere = jittered(mesh::spheres({{Vec3{}, 1.0}}, edge), edge, 0.2);
    for (Vec3& x : sphere.position) x[0] *= 0.9;
    take_volumes_as_targets(sphere);
    Options options;
    options.remeshing = false;
    const auto solver = started(unit_problem(std::move(sphere), edge), options);
    const Course course = run(*solver, 40.0);
    report("sphere, fixed", course);
    EXPECT_LT(course.energy_spread(), 0.05 * course.largest_kinetic);
    EXPECT_LT(course.volume_error, 1e-6);
    EXPECT_LT(course.impulse, 1e-10);
}

TEST(Course, OfAJitteredSphereDoesNotBlowUpWithRemeshing) {
    const double edge = 0.3;
    mesh::FoamMesh sphere = jittered(mesh::spheres({{Vec3{}, 1.0}}, edge), edge, 0.2);
    for (Vec3& x : sphere.position) x[0] *= 0.9;
    take_volumes_as_targets(sphere);
    const auto solver = started(unit_problem(std::move(sphere), edge), {});
    const Course course = run(*solver, 40.0);
    report("sphere, remeshed", course);
    EXPECT_LT(course.largest_energy, 1.01 * course.least_energy);
    EXPECT_LT(course.volume_error, 1e-6);
    EXPECT_LT(course.impulse, 1e-10);
}

TEST(Course, OfAnUnevenDoubleBubbleDoesNotBlowUpWithRemeshing) {
    const double edge = 0.3;
    mesh::FoamMesh bubbles = mesh::double_bubble(mesh::double_bubble_of_radii(1.0, 1.0), edge);
    for (Vec3& x : bubbles.position) x[0] *= 1.05, x[1] += 0.05 * x[1] * x[0];
    take_volumes_as_targets(bubbles);
    const auto solver = started(unit_problem(std::move(bubbles), edge), {});
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
        EXPECT_LT(course.volume_error, 1e-3);
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
    const Course course = run(*solver, 4.0);
    report("two bubbles meet", course);
    bool merged = false;
    for (const sim::Event& e : solver->take_events()) merged |= e.kind == "merge";
    EXPECT_TRUE(merged);
    EXPECT_EQ(scalar(*solver, "bubbles"), 2.0);
    EXPECT_EQ(solver->topology().clusters, 1U);
    EXPECT_LT(course.volume_error, 1e-6);
    EXPECT_LT(course.largest_energy, 1.01 * (scalar(*started(unit_problem(mesh::spheres({{{{-1.15, 0, 0}}, 1.0}, {{{1.15, 0, 0}}, 1.0}}, 0.25), 0.25), {}), "energy") + 2 * 0.75 * 4.18879 * 0.36));
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
