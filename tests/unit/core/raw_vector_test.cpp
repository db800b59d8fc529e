#include "lamella/core/raw_vector.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <string>

namespace lamella {
namespace {

TEST(RawVector, KeepsWhatItIsGivenThroughResizesAndCopies) {
    RawVector<double> values(100000);
    std::iota(values.begin(), values.end(), 0.0);
    values.resize(300000);
    RawVector<double> copy = values;
    for (std::size_t i = 0; i < 100000; ++i) ASSERT_EQ(copy[i], static_cast<double>(i));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(copy.data()) % 64, 0U);
}

TEST(RawVector, FillsWithAValueWhereOneIsGiven) {
    const RawVector<int> sevens(1000, 7);
    EXPECT_EQ(std::accumulate(sevens.begin(), sevens.end(), 0), 7000);
    RawVector<std::string> words(3);  // what has a constructor is constructed
    words.emplace_back("film");
    EXPECT_EQ(words[1] + words[3], "film");
}

}  // namespace
}  // namespace lamella
