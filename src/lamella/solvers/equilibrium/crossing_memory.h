#pragma once

#include "lamella/mesh/tracker.h"
#include "lamella/sim/archive.h"

#include <vector>

namespace lamella::equilibrium {

/// Remembers where regions were parted, to end T1 that undo each other.
///
/// A film that is shorter at rest than the shortest edge of the mesh opens at a crossing, shrinks until it is closed, and
/// opens again. Every such cycle parts the same two regions at the same place, whatever else it does. After a few of
/// them the crossing is held: the films come to rest with that film closed, which costs less area than the mesh can show.
class CrossingMemory {
public:
    CrossingMemory() = default;
    /// As it was saved.
    explicit CrossingMemory(sim::StateReader& in);
    void save(sim::StateWriter& out) const;

    /// @returns whether this parting was one too many: `held` has changed
    bool note_parting(const mesh::TopologyEvent& parting, double edge_length);
    std::vector<mesh::Crossing> held() const;

private:
    struct Seen {
        mesh::Crossing crossing;  ///< where it was last
        int times = 0;
    };
    std::vector<Seen> seen_;
};

}  // namespace lamella::equilibrium
