#include "lamella/dist/partition.h"

#include "lamella/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace lamella::dist {
namespace {

template <int D>
struct Cloud {
    spatial::PeriodicBox<D> box;
    std::array<std::vector<double>, D> x;

    std::size_t size() const { return x[0].size(); }
    Vec<D> point(std::size_t i) const {
        Vec<D> p;
        for (std::size_t k = 0; k < D; ++k) p[k] = x[k][i];
        return p;
    }
    std::array<const double*, D> pointers() const {
        std::array<const double*, D> p;
        for (std::size_t k = 0; k < D; ++k) p[k] = x[k].data();
        return p;
    }
};

/// Points everywhere but in a ball that takes about 35 % of the box.
template <int D>
Cloud<D> cloud_with_void(std::size_t count, bool walls) {
    Cloud<D> cloud;
    for (std::size_t k = 0; k < D; ++k) {
        cloud.box.lengths[k] = 10.0 + 3.0 * static_cast<double>(k);
        cloud.box.periodic[k] = !walls || k != 0;
    }
    const double radius = D == 2 ? 3.8 : 5.8;
    for (std::uint64_t n = 0; cloud.size() < count; ++n) {
        const Vec<D> u = uniform_vector<D>(random_bits(3, RandomStream::kBubblePosition, 0, n));
        Vec<D> p;
        double squared = 0.0;
        for (std::size_t k = 0; k < D; ++k) {
            p[k] = u[k] * cloud.box.lengths[k];
            squared += std::pow(p[k] - 0.4 * cloud.box.lengths[k], 2);
        }
        if (squared < radius * radius) continue;
        for (std::size_t k = 0; k < D; ++k) cloud.x[k].push_back(p[k]);
    }
    return cloud;
}

std::vector<std::int64_t> even(int parts) { return std::vector<std::int64_t>(static_cast<std::size_t>(parts), 1); }

template <int D>
double imbalance(const Cloud<D>& cloud, int parts) {
    Alone alone;
    const Partition<D> partition(alone, cloud.box, cloud.pointers(), cloud.size(), even(parts));
    std::vector<std::size_t> load(static_cast<std::size_t>(parts));
    for (std::size_t i = 0; i < cloud.size(); ++i) ++load[static_cast<std::size_t>(partition.owner(cloud.point(i)))];
    return static_cast<double>(*std::max_element(load.begin(), load.end())) * parts / static_cast<double>(cloud.size());
}

TEST(Partition, IsBalancedAroundAVoid) {
    EXPECT_LE(imbalance(cloud_with_void<2>(20'000, false), 4), 1.02);
    EXPECT_LE(imbalance(cloud_with_void<3>(20'000, true), 4), 1.02);
    EXPECT_LE(imbalance(cloud_with_void<2>(20'000, false), 7), 1.02);
    EXPECT_LE(imbalance(cloud_with_void<2>(200'000, false), 1024), 1.05);
    EXPECT_LE(imbalance(cloud_with_void<3>(200'000, true), 1024), 1.05);
}

TEST(Partition, SharesOutInProportion) {
    const Cloud<2> cloud = cloud_with_void<2>(20'000, false);
    const std::vector<std::int64_t> weights{1024, 1280, 768, 1024, 900};
    Alone alone;
    const Partition<2> partition(alone, cloud.box, cloud.pointers(), cloud.size(), weights);
    std::vector<double> load(weights.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) load[static_cast<std::size_t>(partition.owner(cloud.point(i)))] += 1;
    for (std::size_t p = 0; p < weights.size(); ++p)
        EXPECT_NEAR(load[p] / 20'000.0 / (static_cast<double>(weights[p]) / 4996.0), 1.0, 0.005) << p;
}

template <int D>
void expect_all_near_parts_found(bool walls) {
    const Cloud<D> cloud = cloud_with_void<D>(1500, walls);
    Alone alone;
    const Partition<D> partition(alone, cloud.box, cloud.pointers(), cloud.size(), even(23));
    const Vec<D> inverse = cloud.box.inverse_lengths();
    std::size_t inside = 0;
    for (std::size_t i = 0; i < cloud.size(); i += 7) {
        const double reach = 0.2 + 0.002 * static_cast<double>(i);
        std::set<int> found;
        partition.for_each_near(cloud.point(i), reach,
                                [&](int part) { EXPECT_TRUE(found.insert(part).second) << "twice"; });
        for (std::size_t j = 0; j < cloud.size(); ++j) {
            Vec<D> s = cloud.point(i) - cloud.point(j);
            for (std::size_t k = 0; k < D; ++k) s[k] -= cloud.box.lengths[k] * std::nearbyint(s[k] * inverse[k]);
            if (norm(s) < reach) {
                EXPECT_TRUE(found.contains(partition.owner(cloud.point(j))));
            }
        }
        if (i == 0) {
            EXPECT_LT(found.size(), 12U);  // not simply all of them
        }
        const int own = partition.owner(cloud.point(i));
        for (int p = 0; p < partition.parts(); ++p) EXPECT_EQ(partition.part(p).holds(cloud.point(i)), p == own);
        const Part<D> part = partition.part(own);
        if (part.holds_all_near(cloud.point(i), reach)) {
            EXPECT_EQ(found, std::set<int>{own});
        }
        if (part.holds_all_near(cloud.point(i), 0.01)) ++inside;
    }
    EXPECT_GT(inside, cloud.size() / 14) << "of every seventh point, more than half";
}

TEST(Partition, FindsEveryPartNearABall) {
    expect_all_near_parts_found<2>(false);
    expect_all_near_parts_found<2>(true);
    expect_all_near_parts_found<3>(false);
    expect_all_near_parts_found<3>(true);
}

TEST(Partition, OwnsPointsBeyondWallsAndOtherImages) {
    const Cloud<2> cloud = cloud_with_void<2>(1000, true);
    Alone alone;
    const Partition<2> partition(alone, cloud.box, cloud.pointers(), cloud.size(), even(9));
    Vec2 inside = cloud.point(5);
    Vec2 image = inside;
    image[1] += 2.0 * cloud.box.lengths[1];
    EXPECT_EQ(partition.owner(image), partition.owner(inside));
    inside[0] = 0.0;
    Vec2 beyond = inside;
    beyond[0] = -0.3;
    EXPECT_EQ(partition.owner(beyond), partition.owner(inside));
    std::set<int> found;
    partition.for_each_near(beyond, 0.01, [&](int part) { found.insert(part); });
    EXPECT_TRUE(found.contains(partition.owner(beyond)));
}

TEST(Partition, SurvivesMorePartsThanPoints) {
    const Cloud<2> cloud = cloud_with_void<2>(3, false);
    Alone alone;
    const Partition<2> partition(alone, cloud.box, cloud.pointers(), cloud.size(), even(16));
    std::set<int> owners;
    for (std::size_t i = 0; i < cloud.size(); ++i) owners.insert(partition.owner(cloud.point(i)));
    EXPECT_GE(owners.size(), 2U);
    for (const int owner : owners) EXPECT_LT(owner, 16);
}

}  // namespace
}  // namespace lamella::dist
