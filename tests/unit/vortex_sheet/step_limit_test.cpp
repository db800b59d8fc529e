#include "lamella/solvers/vortex_sheet/step_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lamella::vortex_sheet {
namespace {

using spatial::VortexKernel;

TEST(CapillaryStepLimit, IsThatOfTheFastestWaveWhereTheMeshResolvesIt) {
    // 2 / omega_max in units of sqrt(rho delta^3 / sigma): 27 e^-3 at k delta = 3, 5.893 and 15.8.
    const double sigma = 0.025, rho = 1.2, edge = 1e-3, smoothing = 3.0;
    const double unit = std::sqrt(rho * std::pow(smoothing * edge, 3) / sigma);
    EXPECT_NEAR(capillary_step_limit(VortexKernel::kPlummer, smoothing, edge, sigma, rho) / unit, 1.725, 1e-3);
    EXPECT_NEAR(capillary_step_limit(VortexKernel::kK2, smoothing, edge, sigma, rho) / unit, 0.824, 1e-3);
    EXPECT_NEAR(capillary_step_limit(VortexKernel::kK3, smoothing, edge, sigma, rho) / unit, 0.503, 1e-3);
}

TEST(CapillaryStepLimit, IsThatOfTheShortestWaveOfACoarseMesh) {
    // Plummer with delta = h / 2: the mesh cuts at k h = pi, 0.788 sqrt(rho h^3 / sigma)
    EXPECT_NEAR(capillary_step_limit(VortexKernel::kPlummer, 0.5, 1.0, 1.0, 1.0), 0.788, 1e-3);
}

TEST(KernelFactor, FallsShortOfOneByFirstSecondAndThirdOrder) {
    const double x = 1e-2;
    EXPECT_NEAR(1.0 - kernel_factor(VortexKernel::kPlummer, x), x, x * x);
    EXPECT_NEAR(1.0 - kernel_factor(VortexKernel::kK2, x), x * x / 2, x * x * x);
    EXPECT_NEAR(1.0 - kernel_factor(VortexKernel::kK3, x), x * x * x / 6, x * x * x * x);
}

}  // namespace
}  // namespace lamella::vortex_sheet
