#pragma once

// Circulations and velocities follow the mesh through every edit of the tracker. Jumps across films are interpolated,
// never the values of one region between vertices whose regions differ [method sheet 14.2].

#include "lamella/solvers/vortex_sheet/sheet.h"

#include "lamella/core/small_vector.h"
#include "lamella/core/vec.h"
#include "lamella/mesh/tracker.h"

#include <functional>
#include <span>
#include <vector>

namespace lamella::vortex_sheet {

/// The values of one vertex: one per region.
struct RegionValue {
    mesh::RegionId region;
    double value;
};
using RegionValues = SmallVector<RegionValue, 5>;

/// Weighted mean of vertices that may touch different regions. Regions that all of them touch are interpolated, each
/// vertex taken relative to its own mean over these; any other region keeps its jump to them.
RegionValues blend(std::span<const RegionValues> parents, std::span<const double> weights);

/// Carries what belongs to vertices through one `remesh` or `pop` of a tracker:
///
///     Transfer transfer(topology, phi, velocity);
///     tracker.set_resampler(transfer.resampler());
///     tracker.remesh();
///     ... = transfer.finish(tracker.mesh(), tracker.maps(), events);
class Transfer {
public:
    Transfer(const SheetTopology& topology, const Circulation& phi, const IdVector<mesh::VertexId, Vec3>& velocity);
    Transfer(const Transfer&) = delete;
    Transfer& operator=(const Transfer&) = delete;

    /// Refers to this object.
    std::function<void(const mesh::Resampling&)> resampler();

    struct Result {
        SheetTopology topology;
        Circulation phi;
        IdVector<mesh::VertexId, Vec3> velocity;
        std::vector<mesh::VertexId> edited;  ///< vertices that an edit gave new values, ascending
    };
    /// @param events  those of the same remesh or pop: which region came from which
    Result finish(const mesh::FoamMesh& mesh,
                  const mesh::CompactionMaps& maps,
                  std::span<const mesh::TopologyEvent> events) const;

private:
    IdVector<mesh::VertexId, RegionValues> values_;
    IdVector<mesh::VertexId, Vec3> velocity_;
    std::vector<mesh::VertexId> edited_;
};

}  // namespace lamella::vortex_sheet
