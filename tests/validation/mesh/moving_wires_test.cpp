// Films whose wires move: the rim goes where the wire goes, and the rest of the film follows by itself.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "../../unit/mesh/popping.h"
#include "lamella/mesh/check.h"
#include "lamella/mesh/shapes/wire_films.h"

namespace lamella::mesh {
namespace {

using namespace test;

using Motion = std::function<Vec3(const Vec3& at_start, int step)>;

/// A flow whose wire vertices are led along a motion. Wire vertices stand first in the mesh and are never removed, but
/// a compaction may shift them: each keeps its place at the start along the tracker's maps.
class LedFlow {
public:
    LedFlow(FoamMesh mesh, double h, Motion motion) : flow_{Tracker(mesh, {.edge_length = h})}, motion_(std::move(motion)) {
        start_ = mesh.position;
    }
    const FoamMesh& mesh() const { return flow_.tracker.mesh(); }
    Tracker& tracker() { return flow_.tracker; }

    /// @returns false after the first fault
    bool advance(int steps) {
        for (int s = 0; s < steps; ++s) {
            ++step_;
            auto d = flow_.displacement();
            for (const VertexId v : d.ids())
                if (mesh().on_wire[v] != 0) d[v] = target(v) - mesh().position[v];
            flow_.tracker.move(d);
            if (!sound("move")) return false;
            flow_.tracker.remesh();
            const auto& to = flow_.tracker.maps().vertex;
            IdVector<VertexId, Vec3> start(mesh().position.size());
            for (const VertexId v : start_.ids())
                if (to[v] != kNoVertex) start[to[v]] = start_[v];
            start_ = start;
            if (!sound("remesh")) return false;
        }
        return true;
    }

    /// How far the worst wire vertex is from where its wire went.
    double lag() const {
        double worst = 0.0;
        for (const VertexId v : mesh().position.ids())
            if (mesh().on_wire[v] != 0) worst = std::max(worst, norm(target(v) - mesh().position[v]));
        return worst;
    }

private:
    Vec3 target(VertexId v) const { return motion_(start_[v], step_); }
    bool sound(const char* after) const {
        const auto found = faults(mesh(), CheckOptions{});
        EXPECT_TRUE(found.empty()) << "step " << step_ << ", after " << after << ": " << found.front();
        return found.empty();
    }

    Flow flow_;
    Motion motion_;
    IdVector<VertexId, Vec3> start_;
    int step_ = 0;
};

std::size_t wire_vertices(const FoamMesh& mesh) {
    return static_cast<std::size_t>(std::count(mesh.on_wire.begin(), mesh.on_wire.end(), std::uint8_t{1}));
}

Vec3 turned(const Vec3& x, double angle) {
    return {{std::cos(angle) * x[0] + std::sin(angle) * x[2], x[1], -std::sin(angle) * x[0] + std::cos(angle) * x[2]}};
}

TEST(MovingWires, PullACatenoidApartUntilItPinchesIntoTwoDiscs) {
    const double h = 0.16;
    LedFlow flow(film_between_rings(1.0, 40, 7), h, [](const Vec3& x, int step) {
        const double apart = 0.002 * std::min(step, 200);  // each ring: 1.0 -> 1.8 between them
        return x + Vec3{{0, 0, x[2] > 0.0 ? apart : -apart}};
    });
    ASSERT_TRUE(flow.advance(600));
    const auto events = flow.tracker().take_events();
    EXPECT_GE(count(events, TopologyEvent::Kind::kMerge) + count(events, TopologyEvent::Kind::kPinch), 1);
    EXPECT_LT(flow.lag(), 1e-12);
    EXPECT_EQ(wire_vertices(flow.mesh()), 80U);
    // Two flat polygons of 40 edges.
    EXPECT_NEAR(total_area(flow.mesh()), 40.0 * std::sin(2.0 * std::numbers::pi / 40.0), 1e-5);
}

TEST(MovingWires, CarryADiscAlongAShiftAndAHalfTurn) {
    const FoamMesh start = disk({}, {{0, 0, 1}}, 1.0, 0.2);
    LedFlow flow(start, 0.2, [](const Vec3& x, int step) {
        const double part = std::min(step, 250) / 250.0;
        return turned(x, std::numbers::pi * part) + Vec3{{2.0 * part, 0.5 * part, 0.0}};
    });
    ASSERT_TRUE(flow.advance(600));
    EXPECT_LT(flow.lag(), 1e-12);
    EXPECT_EQ(wire_vertices(flow.mesh()), wire_vertices(start));
    EXPECT_TRUE(flow.tracker().take_events().empty());
    EXPECT_NEAR(total_area(flow.mesh()) / total_area(start), 1.0, 1e-6);  // flat again
}

TEST(MovingWires, CarryAFrameOfSixFilms) {
    const double h = 0.15;
    const FoamMesh start = frame_cone(FrameShape::kTetrahedron, {}, 1.0, h);
    LedFlow flow(start, h, [](const Vec3& x, int step) {
        const double part = std::min(step, 150) / 150.0;
        return turned(x, 1.5 * part) + Vec3{{0.0, 1.0 * part, 0.0}};
    });
    ASSERT_TRUE(flow.advance(500));
    EXPECT_LT(flow.lag(), 1e-12);
    EXPECT_TRUE(flow.tracker().take_events().empty());
    // The same frame relaxed where it stands: a journey leaves no trace but the places of the vertices.
    LedFlow resting(start, h, [](const Vec3& x, int) { return x; });
    ASSERT_TRUE(resting.advance(350));
    EXPECT_NEAR(total_area(flow.mesh()) / total_area(resting.mesh()), 1.0, 2e-3);
}

}  // namespace
}  // namespace lamella::mesh
