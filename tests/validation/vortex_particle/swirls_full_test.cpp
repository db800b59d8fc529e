// What takes minutes: where the fate of two Taylor vortices turns, on two meshes; their energy; leapfrog [method
// sheet 12.2, 12.3].

#include <gtest/gtest.h>

#include "swirls.h"

namespace lamella::vortex_particle {
namespace {

/// After 8 s.
bool part(double distance, int cells) { return run_pair(distance, cells, 8.0).end > 0.8; }

/// The distance from which two vortices part instead of merging, by bisection to 0.0033 / 2.
double critical_distance(int cells) {
    double merge = 0.60, apart = 0.81;
    for (int k = 0; k < 6; ++k) {
        const double middle = 0.5 * (merge + apart);
        (part(middle, cells) ? apart : merge) = middle;
    }
    return 0.5 * (merge + apart);
}

TEST(TaylorVortices, HaveACriticalDistanceThatTheMeshDoesNotMove) {
    const double coarse = critical_distance(64);
    EXPECT_TRUE(part(coarse + 0.02, 256)) << coarse;
    EXPECT_FALSE(part(coarse - 0.02, 256)) << coarse;
}

TEST(TaylorVortices, KeepTheirEnergy) {
    auto solver = taylor_vortices(0.81, 64);
    solver->start({});
    const double energy = solver->kinetic_energy();
    run_until(*solver, 10.0);
    const double change = solver->kinetic_energy() / energy - 1.0;
    EXPECT_LT(std::abs(change), 0.01) << change;
}

/// Vortices that start in balance with the thickness of an elastic film send no waves out, which would take half a
/// percent of their energy at once.
TEST(TaylorVortices, KeepTheirEnergyInAnElasticFilmInBalance) {
    auto solver = taylor_vortices(
        0.81, 64, {"vortex_particle.incompressible=false", "vortex_particle.start.swirls_in_balance=true"});
    solver->start({});
    const double energy = solver->kinetic_energy();
    run_until(*solver, 10.0);
    const double change = solver->kinetic_energy() / energy - 1.0;
    EXPECT_LT(std::abs(change), 0.01) << change;
}

/// Cores of a tenth of the vortices' distance stay apart for three swaps. Steps have to be short against a core's turn,
/// 0.06 s: in those of 0.005 s vortices win energy, 2.7 % until the first swap, and the third interval is 5 % too
/// short.
TEST(Leapfrog, SwapsPlacesThreeTimesWhenPointVorticesDo) {
    const std::vector<double> exact = point_swaps(7.4);
    ASSERT_EQ(exact.size(), 3u);
    auto solver = leapfrog(0.04, 1.0 / 64, 0.0025);
    const std::vector<double> found = swaps(*solver, 7.4);
    ASSERT_EQ(found.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
        const double interval = found[k] - (k > 0 ? found[k - 1] : 0.0);
        const double expected = exact[k] - (k > 0 ? exact[k - 1] : 0.0);
        EXPECT_NEAR(interval / expected, 1.0, 0.02) << k;
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
