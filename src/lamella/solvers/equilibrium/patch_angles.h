#pragma once

#include "lamella/mesh/angles.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/equilibrium/patches.h"

#include <cstddef>
#include <vector>

namespace lamella::equilibrium {

/// How far the angles of quadratic patches are from Plateau's laws [rad].
struct PatchAngles {
    /// Between the three films at the middle of a triple edge, from 120 degrees.
    struct Film {
        std::size_t edge;
        double error;  ///< the largest of three
    };
    /// Between the four triple lines at a junction, from 109.47 degrees.
    struct Junction {
        mesh::VertexId vertex;
        double error;  ///< the largest of six
    };
    std::vector<Film> film;
    std::vector<Junction> junction;
    mesh::AngleDeviation films;      ///< mean weighted with the lengths of the edges
    mesh::AngleDeviation junctions;
};

/// What is held by a wire does not count.
PatchAngles patch_angles(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, const Patches& patches);

}  // namespace lamella::equilibrium
