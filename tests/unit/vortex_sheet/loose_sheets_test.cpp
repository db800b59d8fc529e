#include "lamella/solvers/vortex_sheet/loose_sheets.h"

#include "lamella/solvers/vortex_sheet/impulse.h"

#include <gtest/gtest.h>

#include "films.h"
#include <map>
#include <utility>
#include <vector>

namespace lamella::vortex_sheet {
namespace {

constexpr double kEdge = 0.2;

/// A double bubble whose regions' air moves evenly, each its own way, so that the film between them has a slip.
std::unique_ptr<VortexSheetSolver> slipping_double_bubble(PoppedVorticity popped,
                                                          bool impulse_projection = true,
                                                          double edge = kEdge) {
    mesh::FoamMesh bubbles = mesh::double_bubble(mesh::double_bubble_of_radii(1.0, 0.8), edge);
    for (const mesh::RegionId r : bubbles.regions.ids())
        if (bubbles.regions[r].kind == mesh::RegionKind::kClosed)
            bubbles.regions[r].target_volume = mesh::region_volumes(bubbles)[r];
    film::Problem films = unit_problem(std::move(bubbles), edge);
    film::Event pop;
    pop.time = 0.05;
    pop.region = mesh::RegionId{2};
    pop.into = mesh::RegionId{1};
    films.events.push_back(pop);
    Options options;
    options.popped_vorticity = popped;
    options.impulse_projection = impulse_projection;
    auto solver = started(films, options);
    const std::vector<Vec3> wind{{}, {{0.3, 0.5, 0.1}}, {{0.2, -0.6, 0.2}}};
    Circulation phi(solver->topology().size());
    for (const mesh::VertexId v : solver->mesh().position.ids())
        for (std::size_t i = solver->topology().first(v); i < solver->topology().last(v); ++i)
            phi[i] = dot(wind[index(solver->topology().entries.region[i])], solver->mesh().position[v]);
    solver->set_circulation(phi);
    return solver;
}

Vec3 total_impulse(const VortexSheetSolver& solver) {
    return {{scalar(solver, "impulse_x"), scalar(solver, "impulse_y"), scalar(solver, "impulse_z")}};
}

/// Largest and smallest number of triangles at an edge.
std::pair<int, int> edges_of(const LooseSheets& sheets) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
    for (const auto& t : sheets.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++count[std::minmax(t[k], t[(k + 1) % 3])];
    int most = 0, least = 99;
    for (const auto& [edge, faces] : count) {
        most = std::max(most, faces);
        least = std::min(least, faces);
    }
    return {most, least};
}

/// All of a solver's films as a loose sheet.
LooseSheets all_films(const VortexSheetSolver& solver) {
    mesh::CompactionMaps nothing_stays;
    nothing_stays.face.resize(solver.mesh().faces.size());
    for (const mesh::FaceId f : nothing_stays.face.ids()) nothing_stays.face[f] = mesh::kNoFace;
    const SheetState state{solver.mesh(), solver.topology(), solver.circulation()};
    return left_behind(state, IdVector<mesh::VertexId, Vec3>(solver.mesh().position.size()), nothing_stays, state);
}

TEST(LooseSheets, AreTheFilmsWhoseVorticityTheyTookOver) {
    const auto solver = slipping_double_bubble(PoppedVorticity::kLost);
    const LooseSheets sheets = all_films(*solver);
    const SheetGeometry geometry = sheet_geometry(solver->mesh(), solver->topology());
    EXPECT_NEAR(norm(sheets.impulse() - impulse(solver->mesh(), solver->topology(), geometry, solver->circulation())),
                0.0, 1e-12);
    EXPECT_NEAR(norm(sheets.angular_impulse() -
                     angular_impulse(solver->mesh(), solver->topology(), geometry, solver->circulation())),
                0.0, 1e-12);
    EXPECT_EQ(sheets.strengths(), face_strengths(solver->mesh(), solver->topology(), solver->circulation()));
    EXPECT_EQ(sheets.barycenters(), geometry.barycenter);
}

TEST(LooseSheets, KeepTheirVorticityWhenRefined) {
    const auto solver = slipping_double_bubble(PoppedVorticity::kLost);
    LooseSheets sheets = all_films(*solver);
    for (Vec3& x : sheets.position) x = {{2.5 * x[0], 1.5 * x[1], x[2] + x[1] * x[1]}};
    const auto moment = [](const LooseSheets& s) {
        Vec3 sum;
        const std::vector<Vec3> strength = s.strengths(), center = s.barycenters();
        for (std::size_t i = 0; i < strength.size(); ++i) sum += 0.5 * cross(center[i], strength[i]);
        return sum;
    };
    const Vec3 impulse = sheets.impulse(), turn = sheets.angular_impulse(), half_moment = moment(sheets);
    EXPECT_NEAR(norm(impulse - half_moment), 0.0, 1e-12);  // of closed vortex lines the same
    const std::size_t before = sheets.triangles.size();
    const auto films = edges_of(sheets);
    EXPECT_EQ(films, std::pair(3, 2));
    for (int pass = 0; pass < 4; ++pass) sheets.refine(kEdge);
    EXPECT_GT(sheets.triangles.size(), 3 * before);
    EXPECT_NEAR(norm(sheets.impulse() - impulse), 0.0, 1e-12);
    EXPECT_NEAR(norm(sheets.angular_impulse() - turn), 0.0, 1e-12);
    EXPECT_NEAR(norm(moment(sheets) - half_moment), 0.0, 1e-12);
    EXPECT_EQ(edges_of(sheets), films);  // no gaps: edges have as many triangles as before
    for (int pass = 0; pass < 20; ++pass) sheets.refine(1e-3);
    EXPECT_LE(sheets.triangles.size(), sheets.most);
}

/// What a burst does to impulse and kinetic energy, relative; the solver is left where the burst has just been.
struct Change {
    Vec3 impulse;
    double impulse_share, kinetic;
};
Change change_by_burst(VortexSheetSolver& solver) {
    while (solver.time() < 0.0499) solver.advance(0.0499);
    const Vec3 before = total_impulse(solver);
    const double kinetic = scalar(solver, "energy_kinetic");
    while (scalar(solver, "bubbles") > 1.5) solver.advance(0.05);
    const Vec3 change = total_impulse(solver) - before;
    return {change, norm(change) / norm(before), scalar(solver, "energy_kinetic") / kinetic - 1.0};
}

TEST(Popping, ChangesNoFlowWhereTheVorticityStays) {
    // Nothing projects here. Sums in single precision, and tension pushes a little in the step that ends with the
    // burst.
    const auto solver = slipping_double_bubble(PoppedVorticity::kFree, false);
    const Change change = change_by_burst(*solver);
    std::printf("impulse changed by %.2e, kinetic energy by %.2e, %g loose triangles\n", change.impulse_share,
                change.kinetic, scalar(*solver, "loose_triangles"));
    EXPECT_LT(change.impulse_share, 1e-5);
    EXPECT_LT(std::abs(change.kinetic), 1e-4);
}

TEST(Popping, KeepsImpulseAndEnergyAfterwardsWhereTheVorticityStays) {
    const auto solver = slipping_double_bubble(PoppedVorticity::kFree);
    const Vec3 impulse = total_impulse(*solver);
    change_by_burst(*solver);
    const double energy = scalar(*solver, "energy"), kinetic = scalar(*solver, "energy_kinetic");
    while (solver->time() < 1.0) solver->advance(1.0);
    std::printf("energy %.5f (kinetic %.5f) to %.5f (%.5f), %g loose triangles\n", energy, kinetic,
                scalar(*solver, "energy"), scalar(*solver, "energy_kinetic"), scalar(*solver, "loose_triangles"));
    EXPECT_LT(norm(total_impulse(*solver) - impulse), 1e-12 * norm(impulse));
    EXPECT_NEAR(scalar(*solver, "energy") / energy, 1.0, 0.01);
}

TEST(Popping, ChangesImpulseAndEnergyWhereTheVorticityGoesWithTheFilm) {
    // What is lost is what the other choice leaves in the air.
    const auto lost = slipping_double_bubble(PoppedVorticity::kLost, false);
    const auto free = slipping_double_bubble(PoppedVorticity::kFree, false);
    const Change change = change_by_burst(*lost);
    change_by_burst(*free);
    std::printf("lost: impulse changed by %.2e, kinetic energy by %.2e\n", change.impulse_share, change.kinetic);
    EXPECT_GT(change.impulse_share, 0.02);
    EXPECT_GT(std::abs(change.kinetic), 0.02);
    EXPECT_LT(norm(change.impulse + free->loose_sheets().impulse()), 1e-3 * norm(change.impulse));
    EXPECT_TRUE(lost->loose_sheets().empty());
}

/// One bubble sent off that bursts at once: no film is left.
std::unique_ptr<VortexSheetSolver> bursting_bubble(const char* popped) {
    auto solver = solver_of(std::string(R"(
[[bubble]]
radius = 1.0
velocity = [0.7, 0.0, 0.0]
[[event]]
time = 0.01
region = 1
[resolution]
edge_length = 0.25
[time]
end = 1.0
[vortex_sheet]
popped_vorticity = ")") + popped +
                            "\"\n");
    solver->start({});
    return solver;
}

TEST(Popping, OfTheOnlyBubbleLeavesItsVorticityInTheAir) {
    const auto solver = bursting_bubble("free");
    const Vec3 before = total_impulse(*solver);
    solver->advance(0.005);
    const double kinetic = scalar(*solver, "energy_kinetic");
    solver->advance(0.01);
    EXPECT_EQ(solver->mesh().faces.size(), 0U);
    EXPECT_NEAR(norm(total_impulse(*solver) - before), 0.0, 1e-10);
    EXPECT_NEAR(scalar(*solver, "energy_kinetic") / kinetic, 1.0, 1e-4);
    while (solver->time() < 3.0) solver->advance(3.0);
    std::printf("single: later impulse %.3e of %.5f, kinetic %.6f, %g triangles, step %d\n",
                norm(total_impulse(*solver) - before), norm(before), scalar(*solver, "energy_kinetic"),
                scalar(*solver, "loose_triangles"), static_cast<int>(solver->step()));
    // Nothing projects here: what the air keeps by itself, two radii further on.
    EXPECT_LT(norm(total_impulse(*solver) - before), 0.015 * norm(before));
    EXPECT_NEAR(scalar(*solver, "energy_kinetic") / kinetic, 1.0, 0.06);
}

TEST(Popping, OfTheOnlyBubbleLeavesNothingOtherwise) {
    const auto solver = bursting_bubble("lost");
    while (solver->time() < 0.5) solver->advance(0.5);
    EXPECT_EQ(scalar(*solver, "energy"), 0.0);
    EXPECT_EQ(norm(total_impulse(*solver)), 0.0);
}

}  // namespace
}  // namespace lamella::vortex_sheet
