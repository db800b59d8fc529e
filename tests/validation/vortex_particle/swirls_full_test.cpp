// What takes minutes: where the fate of two Taylor vortices turns, on two meshes; leapfrog [method sheet 12.2, 12.3].

#include <gtest/gtest.h>

#include "swirls.h"

namespace lamella::vortex_particle {
namespace {

/// The distance from which two vortices part instead of merging within 8 s, by bisection to 0.0033 / 2.
double critical_distance(int cells) {
    double merge = 0.60, part = 0.81;
    for (int k = 0; k < 6; ++k) {
        const double middle = 0.5 * (merge + part);
        (run_pair(middle, cells, 8.0).end > 0.8 ? part : merge) = middle;
    }
    return 0.5 * (merge + part);
}

TEST(TaylorVortices, HaveACriticalDistanceThatTheMeshDoesNotMove) {
    const double coarse = critical_distance(64), fine = critical_distance(128);
    RecordProperty("coarse", std::to_string(coarse));
    RecordProperty("fine", std::to_string(fine));
    EXPECT_NEAR(coarse, fine, 0.02) << coarse << " " << fine;
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

/// Cores of a tenth of the vortices' distance stay apart for three swaps.
TEST(Leapfrog, SwapsPlacesThreeTimesWhenPointVorticesDo) {
    const std::vector<double> exact = point_swaps(7.4);
    ASSERT_EQ(exact.size(), 3u);
    auto solver = leapfrog(0.04, 1.0 / 64, 0.005);
    const std::vector<double> found = swaps(*solver, 7.4);
    ASSERT_EQ(found.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k] / exact[k], 1.0, 0.05) << k;
}

}  // namespace
}  // namespace lamella::vortex_particle
