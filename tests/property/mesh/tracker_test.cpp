// Whatever is done to a mesh, in whatever order: the rules of FoamMesh hold and no gas is lost.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lamella/core/random.h"
#include "lamella/mesh/check.h"
#include "lamella/mesh/detail/edit_mesh.h"
#include "lamella/mesh/shapes/power_cluster.h"
#include "lamella/mesh/shapes/wire_films.h"
#include "lamella/mesh/tracker.h"

namespace lamella::mesh {
namespace {

constexpr double kEdge = 0.5;

/// A small cluster, or a film on wires.
FoamMesh start_mesh(int shape, std::uint64_t seed) {
    switch (shape) {
        case 0: return disk({}, {{0, 0, 1}}, 1.2, kEdge);
        case 1: return cylinder({}, {{0, 0, 1}}, 1.0, 1.0, 0.4);
        case 2: return frame_cone(FrameShape::kCube, {}, 1.5, kEdge);
        default: return power_cluster(pack_balls(std::vector<double>(static_cast<std::size_t>(shape - 1), 1.0), seed), kEdge);
    }
}

/// A smooth wave and noise, up to 0.3 h: twice the longest step. Wires are moved too.
IdVector<VertexId, Vec3> random_field(const FoamMesh& mesh, std::uint64_t seed) {
    const Vec3 wave = 4.0 * uniform_vector<3>(random_bits(seed, RandomStream::kMeshJitter, 0, 0));
    IdVector<VertexId, Vec3> d(mesh.position.size());
    for (const VertexId v : d.ids()) {
        const double phase = dot(wave, mesh.position[v]);
        const Vec3 noise = uniform_vector<3>(random_bits(seed, RandomStream::kMeshJitter, 1, index(v)));
        d[v] = 0.15 * kEdge * Vec3{{std::sin(phase), std::cos(2.0 * phase), std::sin(3.0 * phase)}} +
               0.15 * kEdge * (noise - Vec3{{0.5, 0.5, 0.5}});
    }
    return d;
}

double gas(const FoamMesh& mesh) {
    double sum = 0.0;
    for (const Region& region : mesh.regions)
        if (region.kind == RegionKind::kClosed) sum += region.target_volume;
    return sum;
}

/// Whether air was taken in from outside, or gas let out: absorbed by it, or cut off from it.
bool trades_with_outside(const std::vector<TopologyEvent>& events, const FoamMesh& before) {
    for (const TopologyEvent& event : events) {
        if (event.kind == TopologyEvent::Kind::kAbsorb || event.kind == TopologyEvent::Kind::kPop)
            if (index(event.b) >= before.regions.size() || before.regions[event.b].kind != RegionKind::kClosed) return true;
        if (event.kind == TopologyEvent::Kind::kSplit)
            if (index(event.a) >= before.regions.size() || before.regions[event.a].kind != RegionKind::kClosed) return true;
    }
    return false;
}

/// One random operation on a tracker. @returns what it was
std::string operate(Tracker& tracker, std::uint64_t choice) {
    const FoamMesh& mesh = tracker.mesh();
    const std::uint64_t seed = choice / 8;
    if (mesh.faces.empty() || choice % 8 < 3) {
        tracker.move(random_field(mesh, seed));
        return "move";
    }
    if (choice % 8 < 6) {
        tracker.remesh();
        return "remesh";
    }
    const Face face = mesh.faces[static_cast<FaceId>(seed % mesh.faces.size())];
    if (choice % 8 == 6) {
        if (mesh.regions[face.back].kind != RegionKind::kClosed) return "nothing";
        tracker.pop(face.back, face.front);
        return "pop";
    }
    if (mesh.regions[face.back].kind == RegionKind::kClosed)
        tracker.set_target_volume(face.back, 1.1 * mesh.regions[face.back].target_volume);
    return "set_target_volume";
}

RC_GTEST_PROP(AnyOperations, LeaveAMeshSoundAndKeepItsGas, ()) {
    const int shape = *rc::gen::inRange(0, 6);
    Tracker tracker(start_mesh(shape, *rc::gen::inRange<std::uint64_t>(0, 1000)), {.edge_length = kEdge});
    const auto choices = *rc::gen::container<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(0, 1 << 20));
    for (const std::uint64_t choice : choices) {
        const FoamMesh before = tracker.mesh();
        const std::string what = operate(tracker, choice);
        const auto found = faults(tracker.mesh());
        if (!found.empty()) RC_FAIL("after " + what + ": " + found.front());
        const auto events = tracker.take_events();
        if (what == "set_target_volume" || trades_with_outside(events, before)) continue;
        RC_ASSERT(std::abs(gas(tracker.mesh()) - gas(before)) <= 1e-12 * gas(before));
    }
}

// Random motion of wires, which nothing remeshes, makes films needles that are only as thick as a motion leaves them.
TEST(CrumpledWires, HoldSoundFilms) {
    for (int shape = 0; shape < 3; ++shape)
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            Tracker tracker(start_mesh(shape, 1), {.edge_length = kEdge});
            for (std::uint64_t step = 0; step < 90; ++step) {
                const std::string what = operate(tracker, random_bits(seed, RandomStream::kMeshJitter, 2, step).word[0] >> 12);
                ASSERT_EQ(faults(tracker.mesh()), std::vector<std::string>{})
                    << "shape " << shape << ", seed " << seed << ", step " << step << ", " << what;
            }
        }
}

RC_GTEST_PROP(Resampling, CoversEveryVertexThatIsNewOrElsewhere, ()) {
    // A value carried along by the callback and the maps alone reaches every vertex.
    Tracker tracker(start_mesh(*rc::gen::inRange(1, 6), 3), {.edge_length = kEdge});
    std::vector<double> value;
    tracker.set_resampler([&](const Resampling& r) {
        double sum = 0.0, weights = 0.0;
        for (std::size_t i = 0; i < r.parents.size(); ++i) {
            RC_ASSERT(index(r.parents[i]) < value.size());
            sum += r.weights[i] * value[index(r.parents[i])];
            weights += r.weights[i];
        }
        RC_ASSERT(std::abs(weights - 1.0) < 1e-12);
        RC_ASSERT(index(r.vertex) <= value.size());  // new ones come in order
        if (index(r.vertex) == value.size()) value.push_back(0.0);
        value[index(r.vertex)] = sum;
    });
    value.assign(tracker.mesh().position.size(), 1.0);
    const auto first = *rc::gen::inRange<std::uint64_t>(0, 1 << 20);
    const auto cycles = *rc::gen::inRange<std::uint64_t>(1, 6);
    for (std::uint64_t seed = first; seed < first + cycles; ++seed) {
        tracker.move(random_field(tracker.mesh(), seed));
        tracker.remesh();
        const auto& to = tracker.maps().vertex;
        RC_ASSERT(to.size() == value.size());
        std::vector<double> compacted(tracker.mesh().position.size(), 0.0);
        for (const VertexId v : to.ids())
            if (to[v] != kNoVertex) compacted[index(to[v])] = value[index(v)];
        value = compacted;
        for (const double x : value) RC_ASSERT(std::abs(x - 1.0) < 1e-9);  // weights sum to one, so a constant stays
    }
}

/// Everything that can be asked of an EditMesh.
std::vector<std::uint32_t> lists(const detail::EditMesh& mesh) {
    std::vector<std::uint32_t> all;
    for (const VertexId v : mesh.mesh().position.ids()) {
        for (const FaceId f : mesh.faces_at(v)) all.push_back(static_cast<std::uint32_t>(f));
        all.push_back(mesh.suspect(v) ? 1U : 0U);
    }
    for (const RegionId r : mesh.mesh().regions.ids()) all.push_back(static_cast<std::uint32_t>(mesh.sides(r)));
    for (const FaceId f : mesh.mesh().faces.ids()) all.push_back(mesh.grid().holds(f) ? 1U : 0U);
    return all;
}

RC_GTEST_PROP(Rollback, RestoresEverythingAfterAnyEdits, ()) {
    detail::EditMesh mesh(start_mesh(*rc::gen::inRange(0, 6), 2), kEdge);
    const FoamMesh before = mesh.mesh();
    const auto lists_before = lists(mesh);
    const auto edits = *rc::gen::container<std::vector<std::uint64_t>>(rc::gen::arbitrary<std::uint64_t>());
    mesh.begin();
    for (const std::uint64_t edit : edits) {
        const FaceId f{static_cast<std::uint32_t>((edit >> 2) % mesh.mesh().faces.size())};
        const VertexId v{static_cast<std::uint32_t>((edit >> 20) % mesh.mesh().position.size())};
        if (edit % 4 == 0) mesh.move_vertex(v, {{0.1, 0.2, 0.3}});
        if (edit % 4 == 1) mesh.add_vertex({{1, 2, 3}}, (edit & 16) != 0);
        if (!mesh.alive(f)) continue;
        if (edit % 4 == 2) mesh.kill_face(f);
        if (edit % 4 == 3 && !mesh.face(f).has(v)) {
            Face face = mesh.face(f);
            face.vertices[0] = v;
            mesh.set_face(f, face);
            mesh.add_face(face);
        }
    }
    mesh.rollback();
    RC_ASSERT(mesh.mesh() == before);
    RC_ASSERT(lists(mesh) == lists_before);
}

}  // namespace
}  // namespace lamella::mesh
