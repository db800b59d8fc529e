#pragma once

// The face form of the method [method sheet 14.1]: strengths of the sheet, fluxes through the vertices, and the two
// operators between pressure and motion, which are transposes of each other, so that the linear system in space
// conserves energy.

#include "lamella/core/vec.h"
#include "lamella/solvers/vortex_sheet/sheet.h"

#include <array>
#include <span>
#include <vector>

namespace lamella::vortex_sheet {

/// What depends on where the vertices are.
struct SheetGeometry {
    std::vector<Vec3> barycenter;   ///< #F [m]
    std::vector<Vec3> area_vector;  ///< #F, from the region behind into the one in front [m^2]
    std::vector<Vec3> outward;      ///< per entry: N_v^r = dV_r/dx_v [m^2]; those of a vertex sum to zero
    /// Per vertex: the pseudo-inverse of sum_r N N^T, rows [1/m^4]. Its rank is the number of directions in which the
    /// vertex changes volumes: 1 on a film, 2 on a triple line, 3 where four regions meet.
    IdVector<mesh::VertexId, std::array<Vec3, 3>> inverse;
};
SheetGeometry sheet_geometry(const mesh::FoamMesh& mesh, const SheetTopology& topology);

/// Strength of each triangle as a vortex, area times sheet strength [m^3/s]:
///   G_f = -1/2 sum_k Gamma_k e_k,   e_k the edge opposite to corner k in the sense of the face  [method sheet 5]
/// A closed film's strengths sum to zero.
std::vector<Vec3> face_strengths(const mesh::FoamMesh& mesh, const SheetTopology& topology, const Circulation& phi);

/// The prescribed flux of each region through each vertex, from the vector potential at the barycentres [m^3/s]:
///   w_v^r = sum_f +-1/2 e_k . A_f,   + where r is behind f
/// Those of a region sum to zero: its volume stays.
std::vector<double> fluxes(const mesh::FoamMesh& mesh, const SheetTopology& topology, std::span<const Vec3> potential);

/// Velocity of the vertices: the mean of the faces around (weighted with area), corrected the shortest way such that
/// N_v^r . u_v = w_v^r for every region at the vertex [m/s].
IdVector<mesh::VertexId, Vec3> vertex_velocity(const SheetTopology& topology,
                                               const SheetGeometry& geometry,
                                               std::span<const Vec3> face_velocity,
                                               std::span<const double> flux);

/// Vertices go straight for a time `dt`, in which N changes: corrects their velocities, the shortest way, such that
/// each free vertex carries its flux over its whole way, (mean of N_v^r) . u_v = w_v^r. Volumes then change by exactly
/// what the fluxes say, whatever the length of the step. The mean area vector of a triangle on its way is that of the
/// middle of the way plus 1/12 of that of its displacements.
///
/// @param start     films at the start of the way
/// @param geometry  of the films near the middle of the way
/// @param velocity  of all vertices; those on wires are left as they are
void carry_fluxes_all_the_way(const mesh::FoamMesh& start,
                              const SheetTopology& topology,
                              const SheetGeometry& geometry,
                              std::span<const double> flux,
                              double dt,
                              IdVector<mesh::VertexId, Vec3>& velocity);

/// The pressures that films of gradient `force` = dE/dx_v [N] ask of the regions around each vertex, least squares of
/// least norm of sum_r p_r N_v^r = force; on a film p_a - p_b = force . N / |N|^2. Per entry [Pa].
/// The transpose of vertex_velocity: at rest all entries of a region agree up to a constant of each vertex.
std::vector<double> film_pressures(const SheetTopology& topology,
                                   const SheetGeometry& geometry,
                                   const IdVector<mesh::VertexId, Vec3>& force);

}  // namespace lamella::vortex_sheet
