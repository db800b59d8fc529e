#include "lamella/solvers/equilibrium/newton.h"

#include "lamella/mesh/edge_faces.h"

#include "../mesh/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella::equilibrium {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct SphereResult {
    double area, pressure;
    int steps, index;
};

SphereResult solve_sphere(int levels, int order) {
    mesh::FoamMesh mesh = mesh::test::spheres({{{{0.3, 0.1, -0.2}}, 1.0}}, levels);
    mesh.regions[mesh::RegionId{1}].target_volume = 1.0;
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    RestSystem flat(mesh, edges, flat_patches(mesh, {}));
    Newton first(flat, Goal::kMinimum);
    EXPECT_TRUE(first.solve(1e-10, 12));
    if (order == 1) return {flat.balance(false).area, first.pressure()[0], first.steps(), first.last().index};
    mesh.position.values() = flat.patches().position;
    RestSystem curved(mesh, edges, quadratic_patches(mesh, edges, {}));
    Newton second(curved, Goal::kMinimum);
    EXPECT_TRUE(second.solve(1e-10, 12));
    return {curved.balance(false).area, second.pressure()[0], second.steps(), second.last().index};
}

TEST(Newton, FindsTheSphereOfAVolumeWithSecondAndSixthOrder) {
    const double area = std::cbrt(36.0 * kPi), pressure = 2.0 * std::cbrt(4.0 * kPi / 3.0);
    for (const int order : {1, 2}) {
        double before = 0.0;
        for (const int levels : {1, 2, 3}) {
            const SphereResult s = solve_sphere(levels, order);
            const double error = s.area / area - 1.0;
            printf("order %d level %d: area error %.2e pressure error %.2e steps %d index %d\n", order, levels, error,
                   s.pressure / pressure - 1.0, s.steps, s.index);
            EXPECT_LE(s.steps, 12);
            EXPECT_EQ(s.index, 0);
            if (levels > 1) { EXPECT_GT(before / error, order == 1 ? 3.8 : 50.0); }
            before = error;
        }
    }
}

}  // namespace
}  // namespace lamella::equilibrium
