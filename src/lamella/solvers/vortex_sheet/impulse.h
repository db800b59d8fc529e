#pragma once

#include "lamella/solvers/vortex_sheet/operators.h"

#include "lamella/core/vec.h"

#include <span>
#include <vector>

namespace lamella::vortex_sheet {

/// Impulse of the flow over the density of air, -sum_f mean(Gamma) area_vector [m^4/s]: what its momentum amounts to.
/// Constant without wires.
Vec3 impulse(const mesh::FoamMesh& mesh, const SheetTopology& topology, const SheetGeometry& geometry, const Circulation& phi);
/// The same about the origin, -sum_f mean(Gamma) x cross area_vector [m^5/s].
Vec3 angular_impulse(const mesh::FoamMesh& mesh,
                     const SheetTopology& topology,
                     const SheetGeometry& geometry,
                     const Circulation& phi);

/// Gives each cluster of films without wires the impulse `wanted` by a uniform flow outside of it, phi_outside += c . x
/// [method sheet 14.2]. Tension is an internal force of a cluster: what the discrete kick gives it is an error of the mesh.
class ImpulseControl {
public:
    ImpulseControl(const mesh::FoamMesh& mesh, const SheetTopology& topology, const SheetGeometry& geometry);

    /// Of each cluster [m^4/s].
    std::vector<Vec3> impulses(const Circulation& phi) const;
    /// Changes those of the free clusters by `change`.
    void add(std::span<const Vec3> change, Circulation& phi) const;
    /// Whether a wire holds the cluster.
    bool held(std::size_t cluster) const { return held_[cluster] != 0; }
    std::size_t clusters() const { return held_.size(); }
    /// Volume that a cluster's outer films enclose [m^3].
    double volume(std::size_t cluster) const { return volume_[cluster]; }

private:
    const mesh::FoamMesh& mesh_;
    const SheetTopology& topology_;
    const SheetGeometry& geometry_;
    std::vector<std::uint8_t> held_;
    std::vector<mesh::RegionId> outer_;  ///< the region around each cluster
    std::vector<double> volume_;
    std::vector<Vec3> center_;
    std::vector<std::array<Vec3, 3>> response_;  ///< change of impulse per c, rows
};

}  // namespace lamella::vortex_sheet
