#include "lamella/mesh/detail/motion.h"

#include "lamella/core/random.h"
#include "lamella/mesh/check.h"
#include "lamella/mesh/detail/face_pairs.h"
#include "lamella/mesh/shapes/power_cluster.h"

#include <gtest/gtest.h>

namespace lamella::mesh::detail {
namespace {

constexpr double kEdge = 0.4;

EditMesh cluster() { return EditMesh(power_cluster(pack_balls({1.0, 1.0, 0.8, 0.7}, 5), kEdge), 1.5 * kEdge); }

/// Every vertex its own way, up to `share` of an edge; every seventh vertex four times farther.
IdVector<VertexId, Vec3> kicks(const EditMesh& mesh, double share, std::uint64_t step) {
    IdVector<VertexId, Vec3> d(mesh.mesh().position.size());
    for (const VertexId v : d.ids()) {
        const Vec3 any = uniform_vector<3>(random_bits(3, RandomStream::kMeshJitter, step, index(v)));
        d[v] = (index(v) % 7 == 0 ? 4.0 : 1.0) * share * kEdge * (2.0 * any - Vec3{{1.0, 1.0, 1.0}});
    }
    return d;
}

std::size_t move(EditMesh& mesh,
                 MotionLimit& limit,
                 IdVector<VertexId, Vec3> d,
                 const IdVector<VertexId, double>& later) {
    const std::size_t held = limit.apply(mesh, 0.15 * kEdge, later, d);
    for (const VertexId v : d.ids()) d[v] += mesh.at(v);
    mesh.set_positions(d);
    return held;
}

TEST(MotionLimit, HoldsTheSameVerticesWithPairsThatItKept) {
    for (const double guess : {0.0, 0.02, 0.3}) {  // too short, for some vertices, and for all
        EditMesh kept = cluster(), fresh = cluster();
        MotionLimit keeps;
        const IdVector<VertexId, double> later(kept.mesh().position.size(), guess * kEdge);
        std::size_t held = 0;
        for (std::uint64_t step = 0; step < 6; ++step) {
            const auto d = kicks(kept, 0.02, step);
            MotionLimit searches;
            const std::size_t now = move(fresh, searches, d, {});
            EXPECT_EQ(move(kept, keeps, d, later), now);
            held += now;
        }
        EXPECT_GT(held, 20U);
        for (const VertexId v : kept.mesh().position.ids())
            for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(kept.at(v)[k], fresh.at(v)[k]) << "vertex " << index(v);
    }
}

TEST(MotionLimit, LetsNothingCross) {
    EditMesh mesh = cluster();
    MotionLimit limit;
    for (std::uint64_t step = 0; step < 30; ++step) {
        const auto d = kicks(mesh, 0.1, step);
        move(mesh, limit, d, IdVector<VertexId, double>(d.size(), 0.1 * kEdge));
    }
    EXPECT_EQ(faults(mesh.mesh()), std::vector<std::string>{});
}

TEST(MotionLimit, LeavesDistancesAboveRounding) {
    FoamMesh films;
    films.regions.resize(3);
    for (const double z : {-0.1, 0.1}) {
        const VertexId a = films.add_vertex({{0, 0, z}}), b = films.add_vertex({{0.4, 0, z}}),
                       c = films.add_vertex({{0, 0.4, z}});
        films.add_face(a, b, c, RegionId{z < 0.0 ? 1U : 0U}, RegionId{z < 0.0 ? 0U : 2U});
    }
    EditMesh mesh(films, kEdge);
    MotionLimit limit;
    for (int step = 0; step < 40; ++step) {
        IdVector<VertexId, Vec3> together(6);
        for (const VertexId v : together.ids()) together[v] = {{0.0, 0.0, mesh.at(v)[2] < 0.0 ? 0.05 : -0.05}};
        move(mesh, limit, together, {});
    }
    const double gap = mesh.at(VertexId{3})[2] - mesh.at(VertexId{0})[2];
    EXPECT_GT(gap, 1e-8 * 0.15 * kEdge);
    EXPECT_LT(gap, 1e-6 * 0.15 * kEdge);
    IdVector<VertexId, Vec3> apart(6);
    for (const VertexId v : apart.ids())
        apart[v] = {{0.0, 0.0, mesh.at(v)[2] < mesh.at(VertexId{3})[2] ? -0.05 : 0.05}};
    for (int step = 0; step < 40; ++step) move(mesh, limit, apart, {});
    EXPECT_GT(mesh.at(VertexId{3})[2] - mesh.at(VertexId{0})[2], 0.1);
}

TEST(FacePairs, AreThoseWhoseBoxesOverlap) {
    const EditMesh mesh = cluster();
    std::vector<FacePairs::Item> items;
    for (const FaceId f : mesh.mesh().faces.ids())  // a few of them huge
        items.push_back({f, mesh.box(f).inflated(index(f) % 50 == 0 ? 1.0 : 0.05)});
    using Pair = std::pair<FaceId, FaceId>;
    const auto pairs = FacePairs(items).collect<Pair>([](FaceId f, FaceId g, std::vector<Pair>& all) {
        all.push_back({f, g});
    });
    std::vector<std::vector<int>> found(items.size(), std::vector<int>(items.size(), 0));
    for (const auto& [f, g] : pairs) ++found[index(f)][index(g)];
    std::size_t overlaps = 0;
    for (std::size_t i = 0; i < items.size(); ++i)
        for (std::size_t j = 0; j < items.size(); ++j) {
            const bool overlap = i < j && items[i].box.overlaps(items[j].box);
            ASSERT_EQ(found[i][j], overlap ? 1 : 0) << i << " " << j;
            overlaps += overlap ? 1 : 0;
        }
    EXPECT_GT(overlaps, 5 * items.size());
}

}  // namespace
}  // namespace lamella::mesh::detail
