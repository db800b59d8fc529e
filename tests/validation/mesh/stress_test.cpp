// Scenes that break trackers: a cluster stirred hard, an edge where four films cross, bubbles inside bubbles.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "../../unit/mesh/popping.h"
#include "lamella/core/random.h"
#include "lamella/mesh/check.h"

namespace lamella::mesh {
namespace {

using namespace test;

testing::AssertionResult sound(const FoamMesh& mesh) {
    const auto found = faults(mesh, CheckOptions{});
    if (found.empty()) return testing::AssertionSuccess();
    return testing::AssertionFailure() << found.front() << " and " << found.size() - 1 << " more";
}

/// 0.15 h of swirl and 0.08 h of white noise in every step, then relaxation.
class Stirred : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Stirred, ClusterStaysSound) {
    const double h = 0.4;
    Flow flow{Tracker(power_cluster(pack_balls(std::vector<double>(8, 1.0), GetParam()), h), {.edge_length = h})};
    for (int step = 0; step < 100; ++step) {
        auto d = flow.displacement();
        if (step < 75)
            for (const VertexId v : d.ids()) {
                const Vec3 x = flow.tracker.mesh().position[v];
                const double r = std::hypot(x[0], x[1]) + h;
                const Vec3 swirl = (0.15 * h * std::cos(x[2])) * Vec3{{-x[1] / r, x[0] / r, std::sin(2.0 * x[0])}};
                const RandomBits bits = random_bits(GetParam(), RandomStream::kMeshJitter, step, index(v));
                d[v] += swirl + 0.16 * h * (uniform_vector<3>(bits) - Vec3{{0.5, 0.5, 0.5}});
            }
        flow.tracker.move(d);
        ASSERT_TRUE(sound(flow.tracker.mesh())) << "step " << step << ", after move";
        flow.last = flow.tracker.remesh();
        ASSERT_TRUE(sound(flow.tracker.mesh())) << "step " << step << ", after remesh";
    }
    EXPECT_LE(flow.last.stuck, 4);
}

INSTANTIATE_TEST_SUITE_P(ThreeSeeds, Stirred, testing::Values(1, 2, 3));

/// The surfaces of labelled cubes of edge h on a grid of n^3 around the origin: label(i, j, k) within, 0 outside.
template <class Label>
FoamMesh cubes(int n, double h, int regions, Label&& label) {
    FoamMesh mesh;
    mesh.regions.push_back({RegionKind::kOpen, 0.0});
    for (int r = 0; r < regions; ++r) mesh.regions.push_back({RegionKind::kClosed, 0.0});
    std::map<std::array<int, 3>, VertexId> known;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [it, fresh] = known.try_emplace(at, kNoVertex);
        if (fresh) it->second = mesh.add_vertex({{h * (at[0] - 0.5 * n), h * (at[1] - 0.5 * n), h * (at[2] - 0.5 * n)}});
        return it->second;
    };
    const auto label_of = [&](const std::array<int, 3>& c) {
        for (const int i : c)
            if (i < 0 || i >= n) return kOutside;
        return static_cast<RegionId>(label(c[0], c[1], c[2]));
    };
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
            for (int k = 0; k <= n; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const std::array<int, 3> front{i, j, k};
                    std::array<int, 3> back = front;
                    --back[axis];
                    if (label_of(back) == label_of(front)) continue;
                    std::array<int, 3> b = front, c = front, d = front;
                    ++b[(axis + 1) % 3];
                    ++c[(axis + 1) % 3];
                    ++c[(axis + 2) % 3];
                    ++d[(axis + 2) % 3];
                    mesh.add_face(vertex(front), vertex(b), vertex(c), label_of(back), label_of(front));
                    mesh.add_face(vertex(front), vertex(c), vertex(d), label_of(back), label_of(front));
                }
    const auto volumes = region_volumes(mesh);
    for (int r = 1; r <= regions; ++r)
        mesh.regions[static_cast<RegionId>(r)].target_volume = volumes[static_cast<RegionId>(r)];
    return mesh;
}

TEST(CrossingEdge, OfACubeCutIntoFourPartsAtAllThirteenVertices) {
    const double h = 0.25;
    Flow flow{Tracker(cubes(12, h, 4, [](int i, int j, int) { return 1 + (i < 6 ? 0 : 1) + (j < 6 ? 0 : 2); }),
                      {.edge_length = h})};
    ASSERT_TRUE(sound(flow.tracker.mesh()));
    const RemeshReport first = flow.tracker.remesh();
    EXPECT_GE(first.separations, 13);
    EXPECT_EQ(first.stuck, 0);
    EXPECT_TRUE(sound(flow.tracker.mesh()));
    const double before = total_area(flow.tracker.mesh());
    for (int step = 0; step < 40; ++step) {
        flow.advance();
        ASSERT_TRUE(sound(flow.tracker.mesh())) << step;
    }
    EXPECT_LT(total_area(flow.tracker.mesh()), 0.95 * before);
    EXPECT_EQ(live_regions(flow.tracker.mesh()), 4U);
}

/// A ball of radius 1.5 (region 1) with smaller ones inside (2, 3, ...).
FoamMesh nested(const std::vector<std::pair<Vec3, double>>& inner) {
    FoamMesh mesh;
    mesh.regions.push_back({RegionKind::kOpen, 0.0});
    const RegionId big = mesh.regions.push_back({RegionKind::kClosed, 0.0});
    add_sphere(mesh, {}, 1.5, 3, big, kOutside);
    for (const auto& [center, radius] : inner)
        add_sphere(mesh, center, radius, 2, mesh.regions.push_back({RegionKind::kClosed, 0.0}), big);
    const auto volumes = region_volumes(mesh);
    for (const RegionId r : mesh.regions.ids())
        if (r != kOutside) mesh.regions[r].target_volume = volumes[r];
    return mesh;
}

/// Relaxes while everything that touches regions from 2 on is pushed along x.
void drift(Flow& flow, int steps, double push) {
    for (int step = 0; step < steps; ++step) {
        auto d = flow.displacement();
        IdVector<VertexId, std::uint8_t> inner(d.size(), 0);
        for (const Face& face : flow.tracker.mesh().faces)
            if (index(face.back) >= 2 || index(face.front) >= 2)
                for (const VertexId v : face.vertices) inner[v] = 1;
        for (const VertexId v : d.ids())
            if (inner[v] != 0) d[v] += Vec3{{push, 0, 0}};
        flow.tracker.move(d);
        ASSERT_TRUE(sound(flow.tracker.mesh())) << step << ", after move";
        flow.last = flow.tracker.remesh();
        ASSERT_TRUE(sound(flow.tracker.mesh())) << step << ", after remesh";
    }
}

TEST(BubbleInABubble, MeetsTheWallAndOutlivesIt) {
    Flow flow{Tracker(nested({{{{0.5, 0.02, 0.01}}, 0.6}}), {.edge_length = 0.25})};
    drift(flow, 60, 0.02);
    auto events = flow.tracker.take_events();
    ASSERT_GE(count(events, TopologyEvent::Kind::kMerge), 1);
    EXPECT_EQ(count(events, TopologyEvent::Kind::kSplit), 0);  // the cavity never was a region of its own
    EXPECT_EQ(live_regions(flow.tracker.mesh()), 2U);
    const double gas = flow.tracker.mesh().regions[RegionId{2}].target_volume;
    flow.tracker.pop(RegionId{1}, kOutside);
    drift(flow, 40, 0.0);
    EXPECT_EQ(live_regions(flow.tracker.mesh()), 1U);
    EXPECT_EQ(flow.tracker.mesh().regions[RegionId{2}].target_volume, gas);
    flow.settle_volumes();
    EXPECT_LT(worst_volume_error(flow.tracker.mesh()), 1e-9);
}

TEST(ClusterInABubble, IsACavityThatFloatsFreelyWhenTheWallPops) {
    // Two balls inside merge with each other, not with the wall.
    Flow flow{Tracker(nested({{{{-0.51, 0, 0}}, 0.5}, {{{0.51, 0.03, 0.02}}, 0.5}}), {.edge_length = 0.25})};
    drift(flow, 40, 0.0);
    const auto events = flow.tracker.take_events();
    EXPECT_GE(count(events, TopologyEvent::Kind::kMerge), 1);
    EXPECT_EQ(live_regions(flow.tracker.mesh()), 3U);
    flow.tracker.pop(RegionId{1}, kOutside);
    drift(flow, 20, 0.0);
    EXPECT_EQ(live_regions(flow.tracker.mesh()), 2U);
    for (const Face& face : flow.tracker.mesh().faces) EXPECT_TRUE(face.back != RegionId{1} && face.front != RegionId{1});
}

TEST(ClusterInABubble, JoinsTheRegionAroundItWhenItPops) {
    Flow flow{Tracker(nested({{{{0, 0, 0}}, 0.6}}), {.edge_length = 0.25})};
    const auto& regions = flow.tracker.mesh().regions;
    const double gas = regions[RegionId{1}].target_volume + regions[RegionId{2}].target_volume;
    flow.tracker.pop(RegionId{2}, RegionId{1});
    EXPECT_TRUE(sound(flow.tracker.mesh()));
    EXPECT_EQ(live_regions(flow.tracker.mesh()), 1U);
    EXPECT_DOUBLE_EQ(flow.tracker.mesh().regions[RegionId{1}].target_volume, gas);
}

}  // namespace
}  // namespace lamella::mesh
