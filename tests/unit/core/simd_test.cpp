// Rows whose ends fill a part of the lanes only.

#include "lamella/core/simd.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

namespace lamella {
namespace {

TEST(Lanes, LoadTheFirstOnesAndZerosInTheOthers) {
    for (std::size_t count = 1; count <= kLanes; ++count) {
        std::vector<float> narrow;
        std::vector<double> wide;
        for (std::size_t l = 0; l < count; ++l) {
            narrow.push_back(0.1F + static_cast<float>(l));
            wide.push_back(0.1 + static_cast<double>(l));
        }
        const Simd a = load_some(narrow.data(), count), b = load_some(wide.data(), count);
        for (std::size_t l = 0; l < kLanes; ++l) {
            EXPECT_EQ(a[l], l < count ? double{narrow[l]} : 0.0);
            EXPECT_EQ(b[l], l < count ? wide[l] : 0.0);
        }
    }
}

TEST(Lanes, GatherTheFirstOnesAndReadNothingBehindThem) {
    const std::vector<double> values{1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0};
    for (std::size_t count = 1; count <= kLanes; ++count) {
        std::vector<std::uint32_t> index;
        for (std::size_t l = 0; l < count; ++l) index.push_back(static_cast<std::uint32_t>(8 - l));
        const Simd a = gather_some(values.data(), index.data(), count);
        for (std::size_t l = 0; l < kLanes; ++l) EXPECT_EQ(a[l], l < count ? values[8 - l] : 0.0);
    }
}

TEST(Lanes, PackWhatIsSmaller) {
    const std::array<double, kLanes> value{3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0};
    for (std::size_t count = 1; count <= kLanes; ++count) {
        std::vector<std::uint32_t> index, wanted;
        std::vector<double> smaller;
        for (std::size_t l = 0; l < count; ++l) {
            index.push_back(static_cast<std::uint32_t>(100 + l));
            if (value[l] >= 4.0) continue;
            wanted.push_back(index[l]);
            smaller.push_back(value[l]);
        }
        std::array<double, kLanes> packed{};
        std::array<std::uint32_t, kLanes> named{};
        const std::size_t found =
            pack_smaller(load_lanes(value.data()), 4.0, index.data(), count, packed.data(), named.data());
        ASSERT_EQ(found, wanted.size());
        for (std::size_t l = 0; l < found; ++l) {
            EXPECT_EQ(packed[l], smaller[l]);
            EXPECT_EQ(named[l], wanted[l]);
        }
    }
}

TEST(Lanes, AddInOneOrder) {
    const std::array<double, kLanes> x{1e16, 1.0, -1e16, 2.0, 3.0, 1e-3, 5.0, -7.0};
    EXPECT_EQ(sum_of_lanes(load_lanes(x.data())), ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7])));
}

}  // namespace
}  // namespace lamella
