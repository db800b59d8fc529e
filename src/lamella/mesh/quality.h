#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <cstddef>

namespace lamella::mesh {

/// Smallest angle of any face [rad]; pi if there is no face.
double min_angle(const FoamMesh& mesh);

struct EdgeLengths {
    std::size_t count = 0;
    double shortest = 0.0;   ///< [m]
    double mean = 0.0;       ///< [m]
    double deviation = 0.0;  ///< standard deviation [m]
    double longest = 0.0;    ///< [m]
};

/// Each edge counts once, however many faces meet at it. All zero if there is no face.
EdgeLengths edge_lengths(const FoamMesh& mesh);

}  // namespace lamella::mesh
