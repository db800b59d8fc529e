#include "lamella/core/nearest_word.h"

#include <gtest/gtest.h>

#include <vector>

namespace lamella {
namespace {

TEST(NearestWord, CountsSingleLetterChanges) {
    EXPECT_EQ(edit_distance("", ""), 0u);
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("count", "count"), 0u);
    EXPECT_EQ(edit_distance("cont", "count"), 1u);
    EXPECT_EQ(edit_distance("coumt", "count"), 1u);
    EXPECT_EQ(edit_distance("conut", "count"), 1u);  // two neighbors swapped
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
    EXPECT_EQ(edit_distance("Gas-Fraction", "gas_fraction"), 0u);
}

TEST(NearestWord, FindsTheOneThatWasMeant) {
    const std::vector<std::string> words{"gas_fraction", "count", "end_count"};
    EXPECT_EQ(nearest_word("gas_fracton", words), "gas_fraction");
    EXPECT_EQ(nearest_word("cuont", words), "count");
    EXPECT_EQ(nearest_word("endcount", words), "end_count");
}

TEST(NearestWord, SaysNothingWhenNoneIsNear) {
    const std::vector<std::string> words{"count", "m"};
    EXPECT_EQ(nearest_word("temperature", words), std::nullopt);
    EXPECT_EQ(nearest_word("x", words), std::nullopt);
    EXPECT_EQ(nearest_word(std::string(100000, 'c'), words), std::nullopt);
    EXPECT_EQ(nearest_word("count", {}), std::nullopt);
}

}  // namespace
}  // namespace lamella
