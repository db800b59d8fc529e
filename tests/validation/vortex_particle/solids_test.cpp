// Solids in a film.

#include "films.h"

#include "lamella/solvers/vortex_particle/solids.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

/// A stick that starts suddenly makes the flow of a dipole around it, u = U a^2 / r^2 (2 (e . n) n - e), n = r / |r|, before
/// anything is shed; the walls are ten radii away and change it by a hundredth.
TEST(Stick, StartsWithPotentialFlowAroundIt) {
    std::vector<double> error;
    for (const double edge : {0.1, 0.05}) {
        auto solver = solver_of(fmt::format(R"(
[[film]]
shape = "rectangle"
center = [-4, -4, 0]
u = [8, 0, 0]
v = [0, 8, 0]
[[solid]]
radius = 0.4
velocity = [1, 0, 0]
[resolution]
edge_length = {}
[vortex_particle]
incompressible = true
largest_step = 0.001
)", edge));
        solver->start({});
        run_until(*solver, 0.002);
        const Surface& s = solver->surface();
        const MeshFlow& flow = solver->observed();
        double square = 0.0, size = 0.0, inside = 0.0;
        for (std::size_t t = 0; t < s.triangles(); ++t) {
            const Vec3 x = s.point(t, {1.0 / 3, 1.0 / 3, 1.0 / 3}) - Vec3{{0.002, 0, 0}};
            const double r = norm(x);
            if (r < 0.4 - edge) inside = std::max(inside, norm(flow.velocity[t] - Vec3{{1, 0, 0}}));
            if (r < 0.6 || r > 1.0) continue;
            const Vec3 exact = 0.16 / (r * r) * (2.0 * x[0] / (r * r) * x - Vec3{{1, 0, 0}});
            square += s.area[t] * squared_norm(flow.velocity[t] - exact);
            size += s.area[t] * squared_norm(exact);
        }
        EXPECT_LT(inside, 0.1);  // of the stick's speed, where it covers the film in part too
        error.push_back(std::sqrt(square / size));
    }
    // It acts as one that is larger by a third of an edge: first order.
    EXPECT_LT(error[1], 0.11);
    EXPECT_GT(std::log2(error[0] / error[1]), 0.9);
}

TEST(Stick, ShedsAsMuchCirculationAsItKeeps) {
    auto solver = solver_of(R"(
[material]
kinematic_viscosity = 1e-3
[[film]]
shape = "rectangle"
center = [-2, -1, 0]
u = [4, 0, 0]
v = [0, 2, 0]
[[solid]]
center = [-1.2, 0.01, 0]
radius = 0.15
velocity = [1, 0, 0]
spin = [0, 0, 1]
end = 1.5
[resolution]
edge_length = 0.0625
)");
    solver->start({});
    run_until(*solver, 2.0);
    const auto& circulation = solver->particles().circulation;
    double size = 0.0;
    for (const double c : circulation) size += std::abs(c);
    EXPECT_GT(size, 0.3);  // two vortices of about U times the diameter
    EXPECT_LT(std::abs(std::accumulate(circulation.begin(), circulation.end(), 0.0)), 1e-11 * size);
    // It stands still now, and so does the film that it covers.
    const Cover cover = cover_of(solver->surface(), {}, 0.0);
    for (std::size_t t = 0; t < solver->surface().triangles(); ++t) {
        const Vec3 x = solver->surface().point(t, {1.0 / 3, 1.0 / 3, 1.0 / 3}) - Vec3{{0.3, 0.01, 0.0}};
        if (norm(x) >= 0.15 - 0.0625) continue;
        EXPECT_LT(norm(solver->observed().velocity[t]), 0.1);
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
