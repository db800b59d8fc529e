#include "lamella/solvers/vortex_sheet/transfer.h"

#include "films.h"

#include <gtest/gtest.h>

#include <array>

namespace lamella::vortex_sheet {
namespace {

using mesh::RegionId;
using mesh::VertexId;

RegionValues values(std::initializer_list<std::pair<std::uint32_t, double>> list) {
    RegionValues result;
    for (const auto& [region, value] : list) result.push_back({RegionId{region}, value});
    return result;
}
double of(const RegionValues& v, std::uint32_t region) {
    for (const auto& [r, value] : v)
        if (r == RegionId{region}) return value;
    ADD_FAILURE() << "region " << region << " is missing";
    return 0.0;
}

TEST(Blend, InterpolatesJumpsAndIgnoresTheConstantOfEachVertex) {
    const std::array parents{values({{0, 1.0}, {1, 4.0}}), values({{0, 100.0}, {1, 95.0}})};
    const RegionValues mean = blend(parents, std::array{0.25, 0.75});
    EXPECT_EQ(mean.size(), 2U);
    EXPECT_DOUBLE_EQ(of(mean, 1) - of(mean, 0), 0.25 * 3.0 + 0.75 * -5.0);
}

TEST(Blend, OfOneVertexIsThatVertex) {
    const std::array parents{values({{0, 1.0}, {2, 4.0}, {5, -3.0}})};
    const RegionValues same = blend(parents, std::array{1.0});
    EXPECT_DOUBLE_EQ(of(same, 2) - of(same, 0), 3.0);
    EXPECT_DOUBLE_EQ(of(same, 5) - of(same, 0), -4.0);
}

TEST(Blend, KeepsTheJumpToARegionThatOneParentAloneTouches) {
    // On a film of regions 0 and 1 and on a triple line 0, 1, 2: the jump 0-1 is interpolated; region 2 keeps its place
    // relative to the mean of 0 and 1, so the loop 0-1, 1-2, 2-0 closes.
    const std::array parents{values({{0, 0.0}, {1, 2.0}}), values({{0, 10.0}, {1, 14.0}, {2, 20.0}})};
    const RegionValues mean = blend(parents, std::array{0.5, 0.5});
    EXPECT_EQ(mean.size(), 3U);
    EXPECT_DOUBLE_EQ(of(mean, 1) - of(mean, 0), 3.0);
    EXPECT_DOUBLE_EQ(of(mean, 2) - 0.5 * (of(mean, 0) + of(mean, 1)), 20.0 - 12.0);
}

TEST(Transfer, KeepsCirculationsThatAreLinearInSpaceThroughRemeshing) {
    // Phi_r = c_r . x: every split and collapse interpolates it exactly, up to where a vertex leaves its edge.
    const double edge = 0.2;
    const mesh::FoamMesh start = mesh::double_bubble(mesh::double_bubble_of_volumes(1, 1), edge);
    mesh::Tracker tracker(start, {.edge_length = 0.7 * edge});
    const SheetTopology topology = sheet_topology(tracker.mesh());
    const auto linear = [](RegionId r, const Vec3& x) {
        return dot(Vec3{{1.0 + static_cast<double>(index(r)), -2.0 * static_cast<double>(index(r)), 0.5}}, x);
    };
    Circulation phi(topology.size());
    IdVector<VertexId, Vec3> velocity(start.position.size());
    for (const VertexId v : start.position.ids()) {
        velocity[v] = {{linear(RegionId{0}, start.position[v]), 0, 0}};
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i)
            phi[i] = linear(topology.entries.region[i], start.position[v]);
    }
    Transfer transfer(topology, phi, velocity);
    tracker.set_resampler(transfer.resampler());
    tracker.remesh();
    const Transfer::Result result = transfer.finish(tracker.mesh(), tracker.maps(), tracker.take_events());
    EXPECT_GT(tracker.mesh().position.size(), start.position.size());
    EXPECT_FALSE(result.edited.empty());
    double worst = 0.0;
    for (const mesh::FaceId f : tracker.mesh().faces.ids())
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& x = tracker.mesh().corner(f, k);
            const mesh::Face& face = tracker.mesh().faces[f];
            worst = std::max(worst, std::abs(jump(result.topology, result.phi, f, k) -
                                             (linear(face.front, x) - linear(face.back, x))));
        }
    // New vertices are put on the curved film, off their edge by up to h^2 / (8 R).
    EXPECT_LT(worst, 2.0 * 5.0 * edge * edge / (8 * 0.65));
}

TEST(Transfer, ClosesEveryLoopAroundTripleLines) {
    // By construction: one value per region. What is tested is that no region of a vertex is left without a value.
    const mesh::FoamMesh start = jittered(mesh::quadruple_bubble(1.0, 0.2), 0.2, 0.1);
    mesh::Tracker tracker(start, {.edge_length = 0.28});
    const SheetTopology topology = sheet_topology(tracker.mesh());
    Circulation phi(topology.size());
    for (std::size_t i = 0; i < phi.size(); ++i) phi[i] = 10.0 * static_cast<double>(index(topology.entries.region[i]));
    Transfer transfer(topology, phi, IdVector<VertexId, Vec3>(start.position.size()));
    tracker.set_resampler(transfer.resampler());
    tracker.remesh();
    const Transfer::Result result = transfer.finish(tracker.mesh(), tracker.maps(), tracker.take_events());
    // Constants of regions stay constants, so every jump is that of its two regions.
    for (const mesh::FaceId f : tracker.mesh().faces.ids())
        for (std::size_t k = 0; k < 3; ++k) {
            const mesh::Face& face = tracker.mesh().faces[f];
            const double wanted = 10.0 * (static_cast<double>(index(face.front)) - static_cast<double>(index(face.back)));
            EXPECT_NEAR(jump(result.topology, result.phi, f, k), wanted, 1e-9);
        }
}

}  // namespace
}  // namespace lamella::vortex_sheet
