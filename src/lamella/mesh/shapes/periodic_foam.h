#pragma once

#include "lamella/mesh/foam_mesh.h"

namespace lamella::mesh {

enum class PeriodicFoam {
    kKelvin,        ///< 2 cells, body-centered cubic
    kWeairePhelan,  ///< 8 cells of two kinds, A15
};

/// One cubic unit cell of a foam that fills space: the Voronoi cells of a crystal, every bubble with the target
/// `volume` [m^3]. Regions 1, 2, ...; nothing is outside.
/// @throws InputError  a size that is not positive, or too many faces
FoamMesh periodic_foam(PeriodicFoam foam, double volume, double edge_length);

}  // namespace lamella::mesh
