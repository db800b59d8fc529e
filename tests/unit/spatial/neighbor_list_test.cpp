#include "lamella/spatial/neighbor_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "lamella/core/parallel.h"
#include "lamella/core/random.h"

namespace lamella::spatial {
namespace {

template <int D>
struct Balls {
    PeriodicBox<D> box;
    std::array<std::vector<double>, D> position;
    std::vector<double> radius;
    std::vector<std::int64_t> id;

    std::array<const double*, D> pointers() const {
        std::array<const double*, D> p;
        for (std::size_t k = 0; k < D; ++k) p[k] = position[k].data();
        return p;
    }
};

template <int D>
Balls<D> random_balls(std::size_t count, Vec<D> lengths, bool walls, double radius, std::uint64_t seed) {
    Balls<D> balls;
    balls.box.lengths = lengths;
    balls.box.periodic.fill(!walls);
    if (walls) balls.box.periodic[0] = true;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec<D> u = uniform_vector<D>(random_bits(seed, RandomStream::kBubblePosition, 0, i));
        for (std::size_t k = 0; k < D; ++k) balls.position[k].push_back(u[k] * lengths[k]);
        balls.radius.push_back(radius * (0.3 + uniform01(random_bits(seed, RandomStream::kBubbleRadius, 0, i))));
        balls.id.push_back(static_cast<std::int64_t>((i * 7919) % count + 1000));
    }
    return balls;
}

/// (id_i, id_j, image) of every pair nearer than R_i + R_j + skin, by looking at all of them.
template <int D>
std::set<std::array<std::int64_t, D + 2>> brute_force(const Balls<D>& b, double skin) {
    std::set<std::array<std::int64_t, D + 2>> pairs;
    constexpr int kMost = 3;
    for (std::size_t i = 0; i < b.radius.size(); ++i)
        for (std::size_t j = 0; j < b.radius.size(); ++j) {
            if (i == j) continue;
            std::array<int, 3> m{};
            const auto most = [&](std::size_t k) { return k < D && b.box.periodic[k] ? kMost : 0; };
            for (m[0] = -most(0); m[0] <= most(0); ++m[0])
                for (m[1] = -most(1); m[1] <= most(1); ++m[1])
                    for (m[2] = -most(2); m[2] <= most(2); ++m[2]) {
                        double squared = 0.0;
                        std::array<std::int64_t, D + 2> pair{b.id[i], b.id[j]};
                        for (std::size_t k = 0; k < D; ++k) {
                            const double s = b.position[k][i] - b.position[k][j] - b.box.lengths[k] * m[k];
                            squared += s * s;
                            pair[k + 2] = m[k];
                        }
                        const double limit = b.radius[i] + b.radius[j] + skin;
                        if (squared < limit * limit) pairs.insert(pair);
                    }
        }
    return pairs;
}

/// The same from the lists; checks order, padding and the permutation on the way.
template <int D>
std::set<std::array<std::int64_t, D + 2>> listed(const Balls<D>& b, double skin) {
    const std::size_t count = b.radius.size();
    const auto search = find_neighbors<D>(b.box, b.pointers(), b.radius.data(), b.id.data(), count, skin);
    EXPECT_EQ(std::set<std::uint32_t>(search.order.begin(), search.order.end()).size(), count);
    EXPECT_EQ(search.list.groups() * kLanes, padded(count));
    std::set<std::array<std::int64_t, D + 2>> pairs;
    for (std::size_t i = 0; i < padded(count); ++i) {
        std::int64_t last_id = -1;
        for (std::size_t e = search.list.group_start[i / kLanes] + i % kLanes;
             e < search.list.group_start[i / kLanes + 1]; e += kLanes) {
            const std::uint32_t j = search.list.index[e];
            if (j == count) continue;
            EXPECT_LT(i, count);
            const std::uint32_t old_i = search.order[i];
            const std::uint32_t old_j = search.order[j];
            std::array<std::int64_t, D + 2> pair{b.id[old_i], b.id[old_j]};
            for (std::size_t k = 0; k < D; ++k) {
                const double s = b.position[k][old_i] - b.position[k][old_j];
                const double nearest_image = b.box.periodic[k] ? std::nearbyint(s / b.box.lengths[k]) : 0.0;
                const double image = search.list.has_images() ? search.list.image[k][e] : nearest_image;
                pair[k + 2] = static_cast<std::int64_t>(image);
            }
            EXPECT_GE(pair[1], last_id) << "lists go by id";
            last_id = pair[1];
            EXPECT_TRUE(pairs.insert(pair).second) << "each pair once";
        }
    }
    return pairs;
}

TEST(NeighborList, HoldsEveryPairOfARandomPacking) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        const bool walls = seed % 2 == 1;
        const auto discs = random_balls<2>(300 + seed, {{25.0, 17.0}}, walls, 1.0, seed);
        EXPECT_EQ(listed(discs, 0.3), brute_force(discs, 0.3));
        const auto balls = random_balls<3>(200 + seed, {{9.0, 11.0, 8.5}}, walls, 1.0, seed);
        EXPECT_EQ(listed(balls, 0.2), brute_force(balls, 0.2));
    }
}

TEST(NeighborList, HoldsEveryImageInASmallBox) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const auto discs = random_balls<2>(1 + seed % 7, {{3.0, 4.0}}, seed % 3 == 0, 1.0, seed);
        EXPECT_EQ(listed(discs, 0.3), brute_force(discs, 0.3));
        const auto balls = random_balls<3>(1 + seed % 5, {{3.0, 12.0, 4.0}}, seed % 3 == 0, 1.0, seed);
        EXPECT_EQ(listed(balls, 0.3), brute_force(balls, 0.3));
    }
}

TEST(NeighborList, CopesWithOneGiantAmongManyDwarfs) {
    auto discs = random_balls<2>(500, {{40.0, 40.0}}, false, 0.4, 3);
    discs.radius[17] = 9.0;
    EXPECT_EQ(listed(discs, 0.1), brute_force(discs, 0.1));
}

TEST(NeighborList, FindsBallsOutsideTheWalls) {
    auto discs = random_balls<2>(60, {{10.0, 10.0}}, true, 1.0, 5);
    discs.position[1][3] = -0.7;
    discs.position[1][4] = 10.9;
    EXPECT_EQ(listed(discs, 0.3), brute_force(discs, 0.3));
}

/// Lists of the balls whose center lies in the box from `low` to `high` (shares of the edges; around the end where high
/// > 1), with the others near it as copies, against those of all balls.
template <int D>
void expect_same_lists_of_a_part(const Balls<D>& b, double skin, double low, double high) {
    const auto inside = [&](std::size_t i) {
        bool in = true;
        for (std::size_t k = 0; k < D; ++k) {
            const double u = b.position[k][i] / b.box.lengths[k];
            in = in && ((u >= low && u < high) || u < high - 1.0);
        }
        return in;
    };
    const auto all = listed(b, skin);
    std::set<std::int64_t> owned_ids;
    std::set<std::int64_t> near_ids;
    for (std::size_t i = 0; i < b.radius.size(); ++i)
        if (inside(i)) owned_ids.insert(b.id[i]);
    for (const auto& pair : all)
        if (owned_ids.contains(pair[0])) near_ids.insert(pair[1]);
    Balls<D> part{b.box, {}, {}, {}};
    const auto take = [&](std::size_t i) {
        for (std::size_t k = 0; k < D; ++k) part.position[k].push_back(b.position[k][i]);
        part.radius.push_back(b.radius[i]);
        part.id.push_back(b.id[i]);
    };
    for (std::size_t i = 0; i < b.radius.size(); ++i)
        if (inside(i)) take(i);
    const std::size_t owned = part.radius.size();
    for (std::size_t i = 0; i < b.radius.size(); ++i)
        if (!inside(i) && near_ids.contains(b.id[i])) take(i);
    const std::size_t count = part.radius.size();
    ASSERT_GT(owned, 0U);

    const double largest = *std::max_element(b.radius.begin(), b.radius.end());
    const auto search = find_neighbors<D>(part.box, part.pointers(), part.radius.data(), part.id.data(), count, skin,
                                          {.count = count - owned, .largest_radius = largest});
    ASSERT_EQ(search.order.size(), owned);
    std::set<std::array<std::int64_t, 2>> found;
    for (std::size_t i = 0; i < padded(owned); ++i)
        for (std::size_t e = search.list.group_start[i / kLanes] + i % kLanes;
             e < search.list.group_start[i / kLanes + 1]; e += kLanes) {
            const std::uint32_t j = search.list.index[e];
            if (j == owned) continue;
            ASSERT_LT(i, owned);
            const bool copy = j >= padded(owned);
            if (copy) {
                EXPECT_GE(i / kLanes, search.list.interior_groups) << "a copy in the list of an interior ball";
            }
            const std::int64_t other = part.id[copy ? owned + j - padded(owned) : search.order[j]];
            found.insert({part.id[search.order[i]], other});
        }
    std::set<std::array<std::int64_t, 2>> expected;
    for (const auto& pair : all)
        if (owned_ids.contains(pair[0])) expected.insert({pair[0], pair[1]});
    EXPECT_EQ(found, expected);
}

TEST(NeighborList, OfAPartOfTheBoxIsThatOfTheWhole) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        const bool walls = seed % 2 == 1;
        for (const auto& [low, high] : {std::pair{0.0, 0.5}, {0.3, 0.6}, {0.75, 1.25}, {0.0, 1.0}, {0.5, 1.0}}) {
            auto discs = random_balls<2>(700, {{60.0, 50.0}}, walls, 1.0, seed);
            if (walls) discs.position[1][3] = -0.7;
            expect_same_lists_of_a_part(discs, 0.3, low, high);
            expect_same_lists_of_a_part(random_balls<3>(900, {{22.0, 24.0, 26.0}}, walls, 0.8, seed), 0.2, low, high);
            expect_same_lists_of_a_part(random_balls<2>(60, {{60.0, 5.0}}, walls, 1.0, seed), 0.3, low, high);
        }
    }
    const auto large = random_balls<2>(20'000, {{250.0, 250.0}}, false, 1.0, 1);
    expect_same_lists_of_a_part(large, 0.3, 0.2, 0.7);
}

TEST(NeighborList, WastesLittleOnGaps) {
    const auto discs = random_balls<2>(20'000, {{250.0, 250.0}}, false, 1.0, 1);
    const auto search =
        find_neighbors<2>(discs.box, discs.pointers(), discs.radius.data(), discs.id.data(), 20'000, 0.3);
    std::size_t used = 0;
    for (const std::uint32_t j : search.list.index) used += j != 20'000;
    EXPECT_LT(static_cast<double>(search.list.index.size()), 1.1 * static_cast<double>(used));
}

TEST(NeighborList, IsTheSameOnAnyNumberOfThreads) {
    const auto balls = random_balls<3>(30'000, {{50.0, 50.0, 50.0}}, false, 1.0, 2);
    const auto find = [&](int threads) {
        ThreadLimit limit(threads);
        return find_neighbors<3>(balls.box, balls.pointers(), balls.radius.data(), balls.id.data(), 30'000, 0.3);
    };
    const auto one = find(1);
    const auto two = find(2);
    EXPECT_EQ(one.order, two.order);
    EXPECT_EQ(one.list.index, two.list.index);
}

}  // namespace
}  // namespace lamella::spatial
