#pragma once

#include "lamella/core/vec.h"
#include "lamella/film/problem.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/foam_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::equilibrium {

/// Films as isoparametric triangles: flat ones with three nodes, or quadratic ones with six.
///
/// Node k < 3 of a patch is corner k of its face; node 3 + k lies between corners k and k + 1. Of all nodes the first
/// #V are the vertices of the mesh, and #V + e is the middle of edge e.
struct Patches {
    int nodes_per_patch = 3;                          ///< 3 or 6
    std::vector<Vec3> position;                       ///< of each node [m]
    std::vector<std::uint8_t> fixed;                  ///< 1: held by a wire
    std::vector<std::array<std::uint32_t, 6>> nodes;  ///< of each patch
    std::vector<std::array<Vec3, 6>> shift;           ///< periodic foams: to be added to the nodes of each patch [m]
    std::vector<mesh::RegionId> back, front;          ///< of each patch
    std::vector<double> tension;                      ///< of each patch, 1 for the material's film

    std::size_t size() const { return nodes.size(); }
    std::array<Vec3, 6> corners(std::size_t patch) const {
        std::array<Vec3, 6> x;
        for (std::size_t k = 0; k < static_cast<std::size_t>(nodes_per_patch); ++k) {
            x[k] = position[nodes[patch][k]];
            if (!shift.empty()) x[k] += shift[patch][k];
        }
        return x;
    }
};

using film::FilmTension;

/// The faces of a mesh as flat patches.
Patches flat_patches(const mesh::FoamMesh& mesh, const std::vector<FilmTension>& tension);

/// The same as quadratic patches; their middle nodes lie in the middle of the straight edges, on wires on the wire.
Patches quadratic_patches(const mesh::FoamMesh& mesh,
                          const mesh::EdgeFaces& edges,
                          const std::vector<FilmTension>& tension);

}  // namespace lamella::equilibrium
