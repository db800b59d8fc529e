#pragma once

// A random cluster that is popped bubble by bubble, for tests of the tracker.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lamella/mesh/shapes/power_cluster.h"
#include "relaxation.h"

namespace lamella::mesh::test {

inline int count(const std::vector<TopologyEvent>& events, TopologyEvent::Kind kind) {
    return static_cast<int>(std::count_if(events.begin(), events.end(), [&](const auto& e) { return e.kind == kind; }));
}

inline std::size_t live_regions(const FoamMesh& mesh) {
    return static_cast<std::size_t>(std::count_if(mesh.regions.begin(), mesh.regions.end(),
                                                  [](const Region& r) { return r.kind == RegionKind::kClosed; }));
}

struct Torture {
    int t1 = 0, merges = 0, pops = 0, worst_stuck = 0;
};

/// Relaxes a random cluster, then pops it bubble by bubble to the last, inflating one now and then.
inline Torture pop_cluster(int bubbles, std::uint64_t seed) {
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
            flow.advance();
            if (s % 5 == 4 && !audit(when + " step " + std::to_string(s))) return false;
        }
        result.worst_stuck = std::max(result.worst_stuck, flow.last.stuck);
        return true;
    };
    if (!audit("start") || !relax(20, "start")) return result;
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
        if (!audit("pop " + std::to_string(round)) || !relax(12, "after pop " + std::to_string(round))) return result;
    }
    EXPECT_EQ(live_regions(flow.tracker.mesh()), 1U);
    flow.settle_volumes();
    EXPECT_LT(worst_volume_error(flow.tracker.mesh()), 1e-9);
    const auto events = flow.tracker.take_events();
    result.t1 = count(events, TopologyEvent::Kind::kT1);
    result.merges = count(events, TopologyEvent::Kind::kMerge);
    result.pops = count(events, TopologyEvent::Kind::kPop);
    return result;
}

}  // namespace lamella::mesh::test
