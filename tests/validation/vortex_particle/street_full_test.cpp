// What takes minutes: the street of vortices behind a disk.

#include "street.h"

#include <gtest/gtest.h>

namespace lamella::vortex_particle {
namespace {

/// Strouhal numbers of a cylinder as measured [Roshko54] and listed in the method sheet, 12.4; a tenth of the width is
/// taken by the disk, which raises them by a few hundredths.
TEST(Street, ShedsVorticesAtTheMeasuredFrequency) {
    for (const auto& [reynolds, strouhal] : {std::pair{100.0, 0.164}, {150.0, 0.18}, {200.0, 0.19}}) {
        auto solver = street(reynolds, 0.05);
        const StreetRun run = run_street(*solver, 40.0, 4);
        EXPECT_NEAR(run.strouhal / strouhal, 1.0, 0.08) << reynolds;
        RecordProperty("drag", std::to_string(run.drag));
        RecordProperty("lift", std::to_string(run.lift));
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
