// What takes minutes: where the fate of two Taylor vortices turns, on two meshes [method sheet 12.2].

#include "swirls.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace lamella::vortex_particle
