// Films that swing with damping come to rest where they should: at the exact areas, with Plateau's angles.

#include "sheets.h"

#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"

#include <cstdio>

namespace lamella::vortex_sheet {
namespace {

double area_error(const VortexSheetSolver& solver, double exact) { return scalar(solver, "polyhedral_area") / exact - 1.0; }
double faces(const VortexSheetSolver& solver) { return scalar(solver, "faces"); }
double volume(const VortexSheetSolver& solver) { return solver.mesh().regions[mesh::RegionId{1}].target_volume; }

void report(const char* name, const VortexSheetSolver& solver, double error) {
    std::printf("%-18s F %5.0f steps %5d  area %+.2e  films %.3f %.3f  lines %.3f %.3f  kinetic %.1e\n", name, faces(solver),
                static_cast<int>(solver.step()), error, scalar(solver, "film_angle_mean_error"),
                scalar(solver, "film_angle_max_error"), scalar(solver, "line_angle_mean_error"),
                scalar(solver, "line_angle_max_error"), scalar(solver, "energy_kinetic"));
}

TEST(Rest, OfTwoBubblesThatTouchIsTheStandardDoubleBubble) {
    const auto solver = solver_of(R"(
[[bubble]]
center = [-0.924, 0.0, 0.0]
radius = 1.0
[[bubble]]
center = [0.924, 0.0, 0.0]
radius = 1.0
[resolution]
edge_length = 0.2
[time]
end = 1.0
[vortex_sheet]
damping = 2.0)");
    solver->start({});
    const Course course = run(*solver, 10.0);
    // 27/4 pi R^2 with 9/8 pi R^3 = V; the volumes are those of the start.
    const double radius = std::cbrt(8.0 * volume(*solver) / (9.0 * 3.14159265358979323846));
    const double exact = 6.75 * 3.14159265358979323846 * radius * radius;
    const double error = area_error(*solver, exact);
    report("double bubble", *solver, error);
    EXPECT_LT(std::abs(error), 5.0 / faces(*solver) + 1e-3);
    // 0.33 degrees here. Patches one edge wide give 0.98: vertices next to the line lie off their films, at any edge length.
    EXPECT_LT(scalar(*solver, "film_angle_mean_error"), 0.5);
    EXPECT_LT(course.volume_error, 1e-6);
}

TEST(Rest, BetweenTwoRingsIsTheCatenoid) {
    struct Case {
        double height, area;
    };
    for (const Case& c : {Case{0.8, 4.883793}, Case{1.2, 6.999643}}) {  // R = a cosh(h / 2a), R = 1
        const double edge = 0.12;
        Options options;
        options.damping = 2.0;
        const auto solver = started(unit_problem(mesh::cylinder({}, {{1, 0, 0}}, 1.0, c.height, edge), edge), options);
        run(*solver, 8.0, 50);
        const double error = area_error(*solver, c.area);
        report("catenoid", *solver, error);
        EXPECT_LT(std::abs(error), 0.003);
    }
}

TEST(Rest, BetweenRingsEndsWhereNoCatenoidIs) {
    // No catenoid beyond h = 1.325487 R; its neck is 0.552434 R there. The rings are pulled so slowly that the film
    // follows through catenoids until then.
    const double edge = 0.12, height = 1.25, speed = 0.005;
    film::Problem films = unit_problem(mesh::catenoid({}, {{1, 0, 0}}, 1.0, height, edge), edge);
    films.wire_of.assign(films.mesh.position.size(), -1);
    for (const double side : {-1.0, 1.0}) {
        film::Wire ring;
        ring.center = {{0.5 * side * height, 0, 0}};
        ring.velocity = {{side * speed, 0, 0}};
        ring.start = 1.0;
        for (const mesh::VertexId v : films.mesh.position.ids())
            if (films.mesh.on_wire[v] != 0 && films.mesh.position[v][0] * side > 0.0)
                films.wire_of[v] = static_cast<std::int32_t>(films.wires.size());
        films.wires.push_back(ring);
    }
    Options options;
    options.damping = 1.2;
    const auto solver = started(films, options);
    const auto neck = [&] {
        double least = 1.0;
        for (const Vec3& x : solver->mesh().position) least = std::min(least, std::hypot(x[1], x[2]));
        return least;
    };
    while (neck() > 0.552434 && solver->time() < 20.0) solver->advance(20.0);
    const double apart = height + 2.0 * speed * (solver->time() - 1.0);
    std::printf("catenoid collapses at h / R = %.4f\n", apart);
    EXPECT_NEAR(apart / 1.325487, 1.0, 0.02);
    const double from = solver->time();
    while (neck() > 0.25 && solver->time() < from + 3.0) solver->advance(from + 3.0);
    EXPECT_LE(neck(), 0.25);  // and goes on
}

TEST(Rest, InAnOctahedralFrameIsTheFlatFilmsOfLeastArea) {
    // Wires of length sqrt(2) a from a cone; 4 sqrt(2) a^2 is the area of the six kites and twelve triangles.
    const auto solver = solver_of(R"(
[[film]]
shape = "frame"
frame = "octahedron"
edge = 1.4142135623730951
[resolution]
edge_length = 0.15
[time]
end = 1.0
[vortex_sheet]
damping = 3.0)");
    solver->start({});
    run(*solver, 8.0, 50);
    const double error = area_error(*solver, 4.0 * std::sqrt(2.0));
    report("octahedron", *solver, error);
    EXPECT_LT(std::abs(error), 1e-3);
}

}  // namespace
}  // namespace lamella::vortex_sheet
