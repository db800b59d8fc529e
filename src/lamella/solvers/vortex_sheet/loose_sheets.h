#pragma once

// Vortex sheets that no film carries: what a film leaves in the air when it bursts.

#include "lamella/core/vec.h"
#include "lamella/mesh/tracker.h"
#include "lamella/solvers/vortex_sheet/sheet.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::vortex_sheet {

/// Triangles that move with the air. Without tension every circulation stays with its air [Da15, eq. 9 without sigma],
/// and a linear circulation on triangles that stretch is vortex stretching: strengths are -1/2 sum_k Gamma_k e_k as on
/// films. They may cross films and each other.
struct LooseSheets {
    std::vector<Vec3> position;  ///< of the vertices [m]
    std::vector<Vec3> velocity;  ///< of the last step [m/s]
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// Of the corners of each triangle [m^2/s]: triangles that meet at a vertex may belong to sheets of different
    /// jumps.
    std::vector<std::array<double, 3>> circulation;
    std::size_t most = 0;  ///< triangles that refining may lead to

    bool empty() const { return triangles.empty(); }
    void add(const LooseSheets& other);
    /// Moved with the velocities of the last step for `dt`.
    LooseSheets ahead(double dt) const;
    std::vector<Vec3> barycenters() const;
    std::vector<Vec3> strengths() const;  ///< [m^3/s]
    /// Velocity of the vertices: the mean of the triangles around, weighted with area [m/s].
    std::vector<Vec3> mean_at_vertices(const Vec3* triangle_velocity) const;
    Vec3 impulse() const;          ///< over the density, as of films [m^4/s]
    Vec3 angular_impulse() const;  ///< the same about the origin [m^5/s]
    /// Halves edges longer than `longest`. Keeps the sum of the strengths and the impulse.
    void refine(double longest);
};

/// Films at one time and their circulations.
struct SheetState {
    const mesh::FoamMesh& mesh;
    const SheetTopology& topology;
    const Circulation& phi;
};

/// The vorticity that films had and have no more after an edit that moved no vertex: triangles that are gone, and on
/// those that stay the change of their circulations, as where the rim of a film that burst has to become smooth. Films
/// and these sheets together are the vortices of before.
/// @param velocity  of the vertices before
/// @param maps      from before to after
LooseSheets left_behind(const SheetState& before,
                        const IdVector<mesh::VertexId, Vec3>& velocity,
                        const mesh::CompactionMaps& maps,
                        const SheetState& after);

}  // namespace lamella::vortex_sheet
