#pragma once

// The method as it was published: velocities at vertices, curvature from dihedral angles, and the smoothing of
// circulations that it needs. For comparison only, [vortex_sheet.compat].

#include "lamella/solvers/vortex_sheet/flow.h"

#include <vector>

namespace lamella::vortex_sheet {

/// sigma H_r from dihedral angles over the mean cell of the vertex's regions, per entry [Pa]. [Da15, eq. 10-11; Fei19]
/// @param surface_tension  of one interface [N/m]
std::vector<double> dihedral_pressures(const mesh::FoamMesh& mesh, const SheetTopology& topology, double surface_tension);

/// Velocity of the vertices, from the law of Biot and Savart at the vertices themselves [m/s].
IdVector<mesh::VertexId, Vec3> point_velocity(const mesh::FoamMesh& mesh,
                                              const SheetTopology& topology,
                                              const SheetGeometry& geometry,
                                              const Circulation& phi,
                                              const spatial::VortexSumOptions& sum);

/// Each jump moves the given share of the way to its mean over the neighbors that have it; then the values of a vertex
/// follow by least squares. [Da15]
void smooth_pairs(const mesh::FoamMesh& mesh, const SheetTopology& topology, double share, Circulation& phi);

}  // namespace lamella::vortex_sheet
