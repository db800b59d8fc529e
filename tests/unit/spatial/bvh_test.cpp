#include "lamella/spatial/bvh.h"

#include "lamella/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lamella::spatial {
namespace {

std::vector<Bounds> random_boxes(std::size_t count, double size) {
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 low = uniform_vector<3>(random_bits(5, RandomStream::kMeshJitter, 0, i));
        const Vec3 side = size * uniform_vector<3>(random_bits(5, RandomStream::kMeshJitter, 1, i));
        boxes.push_back({low, low + side});
    }
    return boxes;
}

TEST(BoxTree, FindsWhatBruteForceFinds) {
    for (const std::size_t count : {1U, 2U, 5U, 300U}) {
        const auto boxes = random_boxes(count, 0.2);
        const BoxTree tree(boxes);
        for (const Bounds& query : random_boxes(40, 0.4)) {
            std::vector<std::size_t> found, expected;
            EXPECT_TRUE(tree.query(query, [&](std::size_t i) {
                found.push_back(i);
                return true;
            }));
            for (std::size_t i = 0; i < count; ++i)
                if (boxes[i].meets(query)) expected.push_back(i);
            std::sort(found.begin(), found.end());
            EXPECT_EQ(found, expected);
        }
    }
}

TEST(BoxTree, StopsWhenToldTo) {
    const BoxTree tree(random_boxes(100, 0.5));
    int calls = 0;
    EXPECT_FALSE(tree.query({{}, {{1.0, 1.0, 1.0}}}, [&](std::size_t) { return ++calls < 3; }));
    EXPECT_EQ(calls, 3);
}

TEST(BoxTree, IsEmptyWithoutBoxesAndTakesEqualOnes) {
    EXPECT_TRUE(BoxTree({}).query({{}, {}}, [](std::size_t) { return false; }));
    const BoxTree same(std::vector<Bounds>(50, Bounds{{}, {{1.0, 1.0, 1.0}}}));
    int calls = 0;
    same.query({{}, {}}, [&](std::size_t) { return ++calls > 0; });
    EXPECT_EQ(calls, 50);
}

}  // namespace
}  // namespace lamella::spatial
