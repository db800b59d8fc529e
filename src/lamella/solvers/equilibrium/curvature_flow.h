#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/equilibrium/patches.h"

#include <vector>

namespace lamella::equilibrium {

/// One implicit step of mean curvature flow at given volumes, for films that are far from rest.
///
///   (L + M / tau) d = -g + G p,   G^T d = missing volumes
///
/// L is the cotangent Laplacian weighted with the tensions, M the lumped mass, g the slope of the area. Unlike Newton's
/// step it moves the nodes in all directions and never fails, but it only creeps once the films are almost at rest.
///
/// @param tau  pseudo time of the step [m^2 for a tension of 1]
/// @returns    displacement of each vertex [m], zero on wires; volumes are corrected by at most a tenth per step
IdVector<mesh::VertexId, Vec3> curvature_flow_step(const mesh::FoamMesh& mesh,
                                                   const std::vector<FilmTension>& tension,
                                                   double tau);

}  // namespace lamella::equilibrium
