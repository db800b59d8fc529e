// Every pair on a GPU, by its CPU twin always and by the GPU where there is one, against the sum on the CPU.

#include "lamella/spatial/detail/vortex_gather.h"

#include "lamella/core/cuda.h"
#include "lamella/core/random.h"
#include "lamella/spatial/vortex_sum.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella::spatial {
namespace {

std::vector<Vec3> random_vectors(std::size_t stream, std::size_t count) {
    std::vector<Vec3> v;
    for (std::size_t i = 0; i < count; ++i)
        v.push_back(uniform_vector<3>(random_bits(7, RandomStream::kMeshJitter, stream, i)) - Vec3{{0.5, 0.5, 0.5}});
    return v;
}

double largest(const std::vector<Vec3>& v) {
    double most = 0.0;
    for (const Vec3& x : v) most = std::max(most, norm(x));
    return most;
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    std::vector<Vec3> d(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
    return largest(d);
}

class VortexGather : public testing::TestWithParam<Device> {
protected:
    void SetUp() override {
        const std::string fault = cuda_fault();
        if (GetParam() == Device::kCuda && !fault.empty()) GTEST_SKIP() << fault;
    }
};

TEST_P(VortexGather, AddsEveryPairAsTheCpuDoes) {
    // Few targets and many sources make several parts; 700 sources do not fill their last tile.
    for (const auto& [targets, sources] : {std::pair<std::size_t, std::size_t>{3, 700}, {260, 300}, {1, 1}}) {
        const auto x = random_vectors(0, targets);
        const auto c = random_vectors(1, sources);
        const auto g = random_vectors(2, sources);
        for (const VortexKernel kernel : {VortexKernel::kPlummer, VortexKernel::kK2, VortexKernel::kK3})
            for (const bool single : {false, true})
                for (const bool potential : {false, true}) {
                    VortexSumOptions options{
                        .kernel = kernel, .delta = 0.1, .method = VortexSumOptions::Method::kDirect};
                    const VortexField expected = vortex_sum(x, c, g, options, potential);
                    options.device = GetParam();
                    if (single) options.precision = VortexSumOptions::Precision::kSingle;
                    const VortexField found = vortex_sum(x, c, g, options, potential);
                    // Rounding of a few hundred terms of either sign; float keeps 1e-6 of the largest.
                    const double allowed = single ? 2e-6 : 1e-13;
                    EXPECT_LE(largest_difference(expected.velocity, found.velocity),
                              allowed * largest(expected.velocity));
                    EXPECT_EQ(found.potential.size(), potential ? targets : 0U);
                    EXPECT_LE(largest_difference(expected.potential, found.potential),
                              allowed * largest(expected.potential));
                    EXPECT_EQ(found.velocity, vortex_sum(x, c, g, options, potential).velocity) << "not repeatable";
                }
    }
}

INSTANTIATE_TEST_SUITE_P(Twin, VortexGather, testing::Values(Device::kCudaTwin));
INSTANTIATE_TEST_SUITE_P(Gpu, VortexGather, testing::Values(Device::kCuda));

TEST(VortexGatherParts, CoverEverySourceOnce) {
    for (const std::size_t targets : {1UL, 100UL, 1000UL, 1000000UL})
        for (const std::size_t sources : {1UL, 255UL, 257UL, 10000UL}) {
            const detail::GatherParts parts = detail::gather_parts(targets, sources);
            ASSERT_GE(parts.parts, 1U);
            EXPECT_EQ(parts.begin(0), 0U);
            EXPECT_EQ(parts.end(parts.parts - 1), sources);
            for (std::size_t p = 0; p < parts.parts; ++p) EXPECT_LT(parts.begin(p), parts.end(p));
        }
}

}  // namespace
}  // namespace lamella::spatial
