#include "lamella/measure/size_distribution.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lamella::measure {
namespace {

TEST(RelativeSizeHistogram, PutsEachSizeIntoItsBin) {
    const std::vector<double> radii{1.0, 1.0, 2.0, 4.0};  // mean 2: relative 0.5, 0.5, 1, 2
    const Histogram histogram = relative_size_histogram(radii, 0.4);
    const std::vector<double> expected{0.0, 2.0, 1.0, 0.0, 0.0, 1.0};  // of 4 balls
    ASSERT_EQ(histogram.density.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_NEAR(histogram.density[k], expected[k] / (4 * 0.4), 1e-14) << k;
    EXPECT_NEAR(histogram.center(1), 0.6, 1e-15);
}

TEST(RelativeSizeHistogram, HasUnitAreaAndDoesNotDependOnTheUnitOfLength) {
    std::vector<double> radii;
    for (int i = 1; i < 500; ++i) radii.push_back(0.5 + std::fmod(i * 0.618, 1.0));
    const Histogram a = relative_size_histogram(radii, 0.05);
    for (double& radius : radii) radius *= 1024.0;
    const Histogram b = relative_size_histogram(radii, 0.05);
    double area = 0.0;
    for (const double density : a.density) area += density * a.bin_width;
    EXPECT_NEAR(area, 1.0, 1e-12);
    EXPECT_EQ(a.density, b.density);
}

TEST(RelativeSizeHistogram, RefusesWhatIsNoRadius) {
    EXPECT_THROW(relative_size_histogram(std::vector<double>{1.0, 0.0}, 0.1), InputError);
    EXPECT_THROW(relative_size_histogram(std::vector<double>{1.0, std::nan("")}, 0.1), InputError);
    EXPECT_THROW(relative_size_histogram(std::vector<double>{1.0}, 0.0), InputError);
    EXPECT_TRUE(relative_size_histogram({}, 0.1).density.empty());
}

}  // namespace
}  // namespace lamella::measure
