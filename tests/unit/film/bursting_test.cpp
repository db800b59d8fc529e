#include "lamella/film/bursting.h"

#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/shapes/standard_clusters.h"

#include <gtest/gtest.h>

#include <set>

namespace lamella::film {
namespace {

using mesh::RegionId;

TEST(LargestNeighbor, IsTheRegionWithMostCommonFilm) {
    const mesh::FoamMesh bubbles = mesh::double_bubble(mesh::double_bubble_of_volumes(1.0, 0.5), 0.3);
    EXPECT_EQ(largest_neighbor(bubbles, RegionId{1}), mesh::kOutside);
    EXPECT_EQ(largest_neighbor(bubbles, RegionId{2}), mesh::kOutside);
    EXPECT_EQ(largest_neighbor(bubbles, RegionId{7}), std::nullopt);
}

TEST(ShareFilm, KnowsWhichRegionsTouch) {
    const mesh::FoamMesh apart = mesh::spheres({{{{-3, 0, 0}}, 1.0}, {{{3, 0, 0}}, 1.0}}, 0.5);
    EXPECT_FALSE(share_film(apart, RegionId{1}, RegionId{2}));
    EXPECT_TRUE(share_film(apart, RegionId{2}, mesh::kOutside));
    const mesh::FoamMesh joined = mesh::double_bubble(mesh::double_bubble_of_volumes(1.0, 1.0), 0.3);
    EXPECT_TRUE(share_film(joined, RegionId{2}, RegionId{1}));
}

TEST(RandomOuterBubble, DrawsEveryBubbleAndTheSameOneAgain) {
    const mesh::FoamMesh bubbles = mesh::triple_bubble(1.0, 0.3);
    std::set<RegionId> drawn;
    for (std::uint64_t draw = 0; draw < 50; ++draw) {
        const auto bubble = random_outer_bubble(bubbles, 3, draw);
        ASSERT_TRUE(bubble);
        EXPECT_EQ(bubble, random_outer_bubble(bubbles, 3, draw));
        drawn.insert(*bubble);
    }
    EXPECT_EQ(drawn, (std::set<RegionId>{RegionId{1}, RegionId{2}, RegionId{3}}));
    EXPECT_EQ(random_outer_bubble(mesh::FoamMesh{}, 3, 0), std::nullopt);
}

}  // namespace
}  // namespace lamella::film
