#include "lamella/mesh/tracker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <numbers>

#include "lamella/mesh/shapes/power_cluster.h"
#include "relaxation.h"

namespace lamella::mesh {
namespace {

using namespace test;

TEST(Tracker, MergesTwoTouchingSpheresIntoADoubleBubble) {
    const double h = 0.3;
    Flow flow{Tracker(spheres({{{{-1.02, 0, 0}}, 1.0}, {{{1.02, 0.1, 0.05}}, 1.0}}, 3), {.edge_length = h})};
    for (int step = 0; step < 200; ++step) {
        flow.advance();
        if (step % 20 == 0) {
            const auto& m = flow.tracker.mesh();
            std::printf("%d: area %.5f V %zu F %zu merges %d t1 %d collapses %d splits %d stuck %d\n", step, total_area(m), m.position.size(), m.faces.size(), flow.last.merges, flow.last.separations, flow.last.collapses, flow.last.splits, flow.last.stuck);
        }
    }
    for (const auto& e : flow.tracker.take_events()) std::printf("%s at %.3f %.3f %.3f\n", std::string(name(e.kind)).c_str(), e.position[0], e.position[1], e.position[2]);
    const double exact = 9.139421678069333 * std::pow(4.0 / 3.0 * std::numbers::pi, 2.0 / 3.0);
    EXPECT_NEAR(total_area(flow.tracker.mesh()) / exact, 1.0, 0.02);
}

struct Torture {
    int t1 = 0, merges = 0, splits = 0, absorbed = 0, pinches = 0, worst_stuck = 0;
    double seconds = 0.0;
    std::size_t steps = 0;
};

/// Relaxes a random cluster, then pops it bubble by bubble to the last, inflating one now and then.
Torture pop_cluster(int bubbles, std::uint64_t seed) {
    Torture result;
    std::vector<double> radii;
    for (int i = 0; i < bubbles; ++i) radii.push_back(0.7 + 0.6 * std::fmod(0.618034 * (i + 1 + static_cast<double>(seed)), 1.0));
    const double h = 0.4;
    Flow flow{Tracker(power_cluster(pack_balls(radii, seed), h), {.edge_length = h})};
    const auto audit = [&](const std::string& when) {
        const auto found = faults(flow.tracker.mesh());
        EXPECT_TRUE(found.empty()) << bubbles << " bubbles, seed " << seed << ", " << when << ": " << found.front() << " and "
                                   << found.size() - 1 << " more";
        return found.empty();
    };
    const auto relax = [&](int steps, const std::string& when) {
        for (int s = 0; s < steps; ++s) {
            const auto begin = std::chrono::steady_clock::now();
            flow.advance();
            result.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            ++result.steps;
            if (s % 5 == 4 && !audit(when + " step " + std::to_string(s))) return false;
        }
        result.worst_stuck = std::max(result.worst_stuck, flow.last.stuck);
        return true;
    };
    if (!audit("start") || !relax(30, "start")) return result;
    for (int round = 0;; ++round) {
        const auto& regions = flow.tracker.mesh().regions;
        std::vector<RegionId> alive;
        for (const RegionId r : regions.ids())
            if (regions[r].kind == RegionKind::kClosed) alive.push_back(r);
        if (alive.size() <= 1) break;
        const RegionId gone = alive[static_cast<std::size_t>(round * 7 + 3) % alive.size()];
        if (round % 3 == 2) flow.tracker.set_target_volume(alive[0], 1.2 * regions[alive[0]].target_volume);
        // Into the neighbor with most film.
        RegionId into = kOutside;
        double most = -1.0;
        for (const auto& film : film_areas(flow.tracker.mesh()))
            if ((film.a == gone || film.b == gone) && film.area > most) {
                most = film.area;
                into = film.a == gone ? film.b : film.a;
            }
        flow.tracker.pop(gone, into);
        if (!audit("pop " + std::to_string(round)) || !relax(20, "after pop " + std::to_string(round))) return result;
    }
    for (const TopologyEvent& e : flow.tracker.take_events()) {
        result.t1 += e.kind == TopologyEvent::Kind::kT1;
        result.merges += e.kind == TopologyEvent::Kind::kMerge;
        result.splits += e.kind == TopologyEvent::Kind::kSplit;
        result.absorbed += e.kind == TopologyEvent::Kind::kAbsorb;
        result.pinches += e.kind == TopologyEvent::Kind::kPinch;
    }
    return result;
}

TEST(Tracker, SurvivesClustersPoppedToTheLastBubble) {
    for (const int bubbles : {5, 8, 12}) {
        const Torture t = pop_cluster(bubbles, 1);
        std::printf("%d bubbles: %zu steps, %.1f ms each, t1 %d merge %d split %d absorb %d pinch %d stuck %d\n", bubbles, t.steps,
                    1e3 * t.seconds / static_cast<double>(t.steps), t.t1, t.merges, t.splits, t.absorbed, t.pinches, t.worst_stuck);
    }
}

}  // namespace
}  // namespace lamella::mesh
