#pragma once

#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/equilibrium/patches.h"

#include <cstdint>
#include <vector>

namespace lamella::equilibrium {

/// Films with a finer mesh, and the quadratic patches on it.
struct Graded {
    mesh::FoamMesh mesh;
    mesh::EdgeFaces edges;
    Patches patches;
};

/// Quadratic patches cut in two along every edge that ends at a marked vertex: half the size there, the same elsewhere, the
/// same shape everywhere.
///
/// Where four triple lines meet, the films' curvature has no limit: beside the tangent cone they differ from it by
/// r^(1 + a) with a < 1, so that the tangents of even meshes converge with h^a only, whatever the degree of the patches.
/// Halving the patches at the junctions a few times costs little and does what an even mesh of that size would do.
/// @param marked  per vertex; none of them on a wire
Graded grade(const mesh::FoamMesh& mesh,
             const mesh::EdgeFaces& edges,
             const Patches& patches,
             const IdVector<mesh::VertexId, std::uint8_t>& marked,
             const std::vector<FilmTension>& tension);

/// Free vertices where four triple lines meet.
IdVector<mesh::VertexId, std::uint8_t> junctions(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges);

}  // namespace lamella::equilibrium
