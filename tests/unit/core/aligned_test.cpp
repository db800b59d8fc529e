#include "lamella/core/aligned.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace lamella {
namespace {

TEST(AlignedVector, BeginsAtACacheLineAtAnyLength) {
    for (const std::size_t n : {1UL, 7UL, 4096UL, 131072UL, 131073UL, 200003UL, 3000000UL}) {
        Column column(n);
        std::iota(column.begin(), column.end(), 0.0);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column.data()) % 64, 0U) << n;
        Column other(n, 1.0);
        EXPECT_EQ(column.back(), static_cast<double>(n - 1)) << "the other one lies elsewhere";
        other = std::move(column);
        EXPECT_EQ(other[n / 2], static_cast<double>(n / 2));
    }
}

TEST(AlignedVector, SaysWhenThereIsNoRoom) {
    CacheLineAllocator<double> allocator;
    for (const std::size_t part : {1UL, 4UL, 8UL})
        EXPECT_THROW(allocator.allocate(std::numeric_limits<std::size_t>::max() / part), std::bad_array_new_length);
}

}  // namespace
}  // namespace lamella
