// Films that swing with damping come to rest where they should: at the exact areas, with Plateau's angles.

#include "sheets.h"

#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"

#include <cstdio>

namespace lamella::vortex_sheet {
namespace {

double area_error(const VortexSheetSolver& solver, double exact) { return scalar(solver, "polyhedral_area") / exact - 1.0; }
double faces(const VortexSheetSolver& solver) { return scalar(solver, "faces"); }

void report(const char* name, const VortexSheetSolver& solver, double error) {
    std::printf("%-18s F %5.0f steps %5d  area %+.2e  films %.3f %.3f  lines %.3f %.3f  kinetic %.1e\n", name, faces(solver),
                static_cast<int>(solver.step()), error, scalar(solver, "film_angle_mean_error"),
                scalar(solver, "film_angle_max_error"), scalar(solver, "line_angle_mean_error"),
                scalar(solver, "line_angle_max_error"), scalar(solver, "energy_kinetic"));
}

TEST(Rest, OfThreeAndFourBubblesHasPlateausAngles) {
    for (const int bubbles : {3, 4}) {
        const double edge = 0.08;
        mesh::FoamMesh cluster = bubbles == 3 ? mesh::triple_bubble(1.0, edge) : mesh::quadruple_bubble(1.0, edge);
        for (Vec3& x : cluster.position) x[0] *= 1.1, x[1] /= 1.1;
        for (mesh::Region& r : cluster.regions)
            if (r.kind == mesh::RegionKind::kClosed) r.target_volume = 1.0;
        Options options;
        options.damping = 3.0;
        const auto solver = started(unit_problem(std::move(cluster), edge), options);
        run(*solver, 6.0, 50);
        // The Surface Evolver's areas of unit bubbles, as in the tests of solver equilibrium.
        const double error = area_error(*solver, bubbles == 3 ? 13.1281682444334 : 16.8965576436161);
        report(bubbles == 3 ? "triple bubble" : "quadruple bubble", *solver, error);
        EXPECT_LT(std::abs(error), 5.0 / faces(*solver) + 1e-3);
        EXPECT_LT(scalar(*solver, "film_angle_mean_error"), 0.5);
        EXPECT_LT(scalar(*solver, "line_angle_mean_error"), 1.0);
    }
}

}  // namespace
}  // namespace lamella::vortex_sheet
