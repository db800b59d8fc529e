#pragma once

// The air that the films drive: velocities and vector potential from the strengths of all triangles, and what is blown
// through rings.

#include "lamella/film/wire.h"
#include "lamella/solvers/vortex_sheet/loose_sheets.h"
#include "lamella/solvers/vortex_sheet/operators.h"
#include "lamella/spatial/vortex_sum.h"

#include <span>
#include <vector>

namespace lamella::vortex_sheet {

/// A vortex ring that is not part of a film: the air that is blown through a ring, as a polygon.
struct BlownRing {
    std::vector<Vec3> center;    ///< of the sides [m]
    std::vector<Vec3> strength;  ///< circulation times side [m^3/s]
    double core = 0.0;           ///< smoothing length: the jet is as smooth as that of a straw [m]
};
/// The rings of all wires that blow at a time.
std::vector<BlownRing> blown_rings(std::span<const film::Wire> wires, double time);

/// The flow at the films and at loose sheets, and what it does to them.
struct Flow {
    std::vector<Vec3> strength;               ///< G_f of the triangles of films, then of loose sheets
    std::vector<Vec3> potential;              ///< A_f of films and loose sheets there
    std::vector<double> flux;                 ///< w, per entry, of films, loose sheets and blown rings
    IdVector<mesh::VertexId, Vec3> velocity;  ///< of the vertices of films [m/s]
    std::vector<Vec3> loose_velocity;         ///< of those of loose sheets [m/s]

    /// Kinetic energy of the air over its density, 1/2 sum_f G_f . A_f [m^5/s^2].
    double energy() const;
};
Flow flow_at(const mesh::FoamMesh& mesh,
             const SheetTopology& topology,
             const SheetGeometry& geometry,
             const Circulation& phi,
             std::span<const BlownRing> blown,
             const spatial::VortexSumOptions& sum,
             const LooseSheets& loose = {});

/// Which entries a flux is demanded of, and which.
struct FluxTarget {
    std::vector<std::uint32_t> entry;  ///< ascending
    std::vector<double> flux;          ///< w wanted there [m^3/s]
};

/// Changes phi at the entries of `target` such that their fluxes become what is wanted: conjugate gradients on the
/// map from circulations to fluxes, which is symmetric and positive (it is the kinetic energy's) [method
/// sheet 7.1, 14.3]. Only the triangles at these entries take part in an iteration.
///
/// @param flux  of phi as it is, per entry
/// @returns  the largest flux that is still missing, over the largest wanted change
double meet_fluxes(const mesh::FoamMesh& mesh,
                   const SheetTopology& topology,
                   const SheetGeometry& geometry,
                   const FluxTarget& target,
                   std::span<const double> flux,
                   double tolerance,
                   const spatial::VortexSumOptions& sum,
                   Circulation& phi);

}  // namespace lamella::vortex_sheet
