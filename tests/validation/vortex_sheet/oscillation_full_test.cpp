// Lamb's frequencies on fine spheres, for every kernel and mode.

#include "oscillation.h"

#include <cstdio>

namespace lamella::vortex_sheet {
namespace {

using spatial::VortexKernel;

TEST(OscillationFull, HasLambsFrequencyAt2562Vertices) {
    // k3, measured over predicted: 0.9999, 0.9977, 0.9943.
    const double edge = 0.0755;
    for (const int l : {2, 3, 4})
        for (const auto kernel : {VortexKernel::kPlummer, VortexKernel::kK2, VortexKernel::kK3}) {
            std::size_t vertices = 0;
            const double omega = frequency(edge, l, plain(kernel), &vertices);
            const double wanted = predicted(kernel, edge, l);
            std::printf("%zu vertices l %d kernel %d: omega/Lamb %.4f predicted %.4f\n", vertices, l,
                        static_cast<int>(kernel), omega / lamb(l), wanted);
            EXPECT_EQ(vertices, 2562U);
            EXPECT_NEAR(omega / lamb(l) / wanted, 1.0, mesh_error(l, edge));  // 0.0018 for l = 2
            if (l == 2 && kernel == VortexKernel::kK3) { EXPECT_NEAR(omega / lamb(l), 1.0, 0.01); }
        }
}

TEST(OscillationFull, ErrorsOfTheTrianglesAreOfSecondOrder) {
    for (const int l : {3, 4}) {
        std::vector<double> error;
        for (const double edge : {0.302, 0.151, 0.0755})
            error.push_back(1.0 - frequency(edge, l, plain(VortexKernel::kK3)) / lamb(l) / predicted(VortexKernel::kK3, edge, l));
        std::printf("l %d: %.4f %.4f %.4f\n", l, error[0], error[1], error[2]);
        EXPECT_GT(std::log2(error[1] / error[2]), 1.7);
        EXPECT_GT(std::log2(error[0] / error[1]), 1.5);
    }
}

}  // namespace
}  // namespace lamella::vortex_sheet
