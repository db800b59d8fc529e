#pragma once

#include "lamella/core/id_vector.h"
#include "lamella/core/vec.h"
#include "lamella/mesh/foam_mesh.h"

namespace lamella::mesh {

/// A motion of the films that gives the bubbles their volumes back.
struct VolumeProjection {
    IdVector<VertexId, Vec3> displacement;  ///< #V [m]
    double error = 0.0;                     ///< largest |V - target| / target before it
};

/// The smallest motion after which every closed region has its target volume: Newton's method for
///
///   minimize sum_v A_v |d_v|^2   at   V_r(x + d) = target_r
///
/// A_v is the film area of a vertex, so that the films move evenly whatever the triangles. Vertices on wires stay. One
/// round leaves the square of the error. A region with more than `largest_change` of its target missing takes so much
/// of it only.
VolumeProjection volume_projection(const FoamMesh& mesh, int rounds = 1, double largest_change = 0.03);

}  // namespace lamella::mesh
