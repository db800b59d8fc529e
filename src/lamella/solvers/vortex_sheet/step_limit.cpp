#include "lamella/solvers/vortex_sheet/step_limit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::vortex_sheet {

double kernel_factor(spatial::VortexKernel kernel, double x) {
    const double decay = std::exp(-x);
    switch (kernel) {
        case spatial::VortexKernel::kPlummer:
            return decay;
        case spatial::VortexKernel::kK2:
            return decay * (1.0 + x);
        case spatial::VortexKernel::kK3:
            return decay * (1.0 + x + 0.5 * x * x);
    }
    return decay;
}

double capillary_step_limit(spatial::VortexKernel kernel,
                            double smoothing_length,
                            double edge_length,
                            double surface_tension,
                            double density) {
    const double delta = smoothing_length * edge_length;
    const double shortest = std::numbers::pi * smoothing_length;  // x of the shortest wave
    constexpr int kSamples = 1000;
    double fastest = 0.0;  // of omega^2 rho delta^3 / sigma
    for (int k = 1; k <= kSamples; ++k) {
        const double x = shortest * k / kSamples;
        fastest = std::max(fastest, x * x * x * kernel_factor(kernel, x));
    }
    return 2.0 * std::sqrt(density * delta * delta * delta / (surface_tension * fastest));
}

}  // namespace lamella::vortex_sheet
