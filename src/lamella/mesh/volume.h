#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/mesh/vertex_regions.h"

#include <vector>

namespace lamella::mesh {

/// Volumes of the closed regions, by the divergence theorem:
///
///   V_r = sum_f s (x0 - c) . ((x1 - c) x (x2 - c)) / 6,   s = +1 where r is behind f, -1 where it is in front
///
/// c is the mean corner of the region's own films: far from the origin no digits are lost.
/// In a periodic foam the result is right if the images of a region's faces fit together; if some are a period apart it
/// is off by an amount that stays the same while vertices move, as long as the region's faces do not change.
///
/// @returns  #R volumes [m^3]; 0 for regions that are open or gone
IdVector<RegionId, double> region_volumes(const FoamMesh& mesh);

/// Gradients of the region volumes with respect to the vertices.
struct VolumeGradient {
    VertexRegions entries;    ///< which vertex touches which region
    std::vector<Vec3> value;  ///< dV_r / dx_v [m^2], one per entry

    /// dV_r / dx_v, zero where they do not touch.
    Vec3 at(VertexId v, RegionId r) const {
        const auto entry = entries.find(v, r);
        return entry ? value[*entry] : Vec3{};
    }
};

/// dV_r/dx_v = sum_f s (area vector of f) / 3 over the faces of r at v, s as in region_volumes.
///
/// The same sum is the outward area vector of the region's surface around v. It is the exact gradient of a closed
/// region, on wires and in periodic foams too. With `kAll` open regions get theirs as well, and then the vectors of
/// each vertex sum to zero.
VolumeGradient volume_gradient(const FoamMesh& mesh, WhichRegions which = WhichRegions::kClosed);

}  // namespace lamella::mesh
