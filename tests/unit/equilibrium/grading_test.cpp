#include "lamella/solvers/equilibrium/grading.h"

#include "lamella/mesh/check.h"
#include "lamella/scene/scene.h"
#include "lamella/scene/shipped.h"
#include "lamella/solvers/equilibrium/equilibrium_solver.h"
#include "lamella/solvers/equilibrium/patch_angles.h"
#include "lamella/solvers/equilibrium/rest_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace lamella::equilibrium {
namespace {

/// Quadratic patches at rest of a shipped scene.
Graded resting(const std::string& name) {
    const auto registry = scene::all_solvers();
    const auto scene = scene::load_scene(scene::resolve_scene_path("equilibrium/" + name), {}, registry);
    const auto solver = scene::create_solver(scene, registry);
    auto& films = dynamic_cast<EquilibriumSolver&>(*solver);
    films.start({});
    while (!films.relaxation().at_rest()) films.advance(1.0);
    const mesh::FoamMesh& mesh = films.relaxation().mesh();
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    RestSystem system(mesh, edges, quadratic_patches(mesh, edges, {}));
    EXPECT_TRUE(Newton(system, Goal::kMinimum).solve(1e-10, 20));
    return {mesh, edges, system.patches()};
}

TEST(Grading, KeepsTheShapeInAirAndInAPeriodicBox) {
    for (const char* scene : {"quadruple-bubble-small", "kelvin-small"}) {
        const Graded whole = resting(scene);
        const Graded cut = grade(whole.mesh, whole.edges, whole.patches, junctions(whole.mesh, whole.edges), {});
        const Balance before = RestSystem(whole.mesh, whole.edges, whole.patches).balance(false);
        const Balance after = RestSystem(cut.mesh, cut.edges, cut.patches).balance(false);
        EXPECT_GT(cut.mesh.faces.size(), whole.mesh.faces.size());
        // Volumes are polynomials of the patches: exact. Areas change by the error of the quadrature, which the cut lowers.
        ASSERT_EQ(before.missing.size(), after.missing.size());
        for (std::size_t r = 0; r < before.missing.size(); ++r) EXPECT_NEAR(before.missing[r], after.missing[r], 1e-13) << scene;
        EXPECT_NEAR(after.area / before.area, 1.0, 1e-6) << scene;
    }
}

TEST(Grading, LeavesAMeshThatObeysTheRules) {
    const Graded whole = resting("quadruple-bubble-small");
    const auto marked = junctions(whole.mesh, whole.edges);
    const Graded cut = grade(whole.mesh, whole.edges, whole.patches, marked, {});
    EXPECT_TRUE(mesh::faults(cut.mesh).empty());
    EXPECT_EQ(std::count(marked.begin(), marked.end(), 1), 5);
    const auto again = junctions(cut.mesh, cut.edges);
    EXPECT_EQ(std::count(again.begin(), again.end(), 1), 5);
    // Every edge at a marked vertex has half its length.
    for (const mesh::VertexId v : marked.ids()) {
        if (!marked[v]) continue;
        const auto longest_at = [&](const Graded& films) {
            double longest = 0.0;
            for (std::size_t e = 0; e < films.edges.size(); ++e)
                if (films.edges.edge[e].a == v || films.edges.edge[e].b == v)
                    longest = std::max(longest, norm(mesh::edge_vector(films.mesh, films.edges.of(e)[0])));
            return longest;
        };
        EXPECT_NEAR(longest_at(cut) / longest_at(whole), 0.5, 0.03);  // edges are curved
    }
}

TEST(Grading, NothingMarkedChangesNothing) {
    const Graded whole = resting("quadruple-bubble-small");
    const IdVector<mesh::VertexId, std::uint8_t> none(whole.mesh.position.size(), 0);
    const Graded same = grade(whole.mesh, whole.edges, whole.patches, none, {});
    EXPECT_EQ(same.mesh.faces.values(), whole.mesh.faces.values());
    EXPECT_EQ(same.patches.position, whole.patches.position);
}

}  // namespace
}  // namespace lamella::equilibrium
