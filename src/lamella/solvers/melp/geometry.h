#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/images.h"
#include "lamella/solvers/melp/neighbors.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/patch.h"
#include "lamella/solvers/melp/tensor.h"
#include "lamella/solvers/melp/voronoi.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lamella::melp {

/// What follows from where the coarse particles are.
struct Geometry {
    NeighborLists neighbors;
    Images images;  ///< what lies beyond rims
    std::vector<Patch> patch;
    std::vector<FitRow> fit_row;  ///< empty where no films of other regions are near
    std::vector<Vec3> normal;
    std::vector<double> curvature;     ///< measured, for reports; no force comes from it [1/m]
    std::vector<double> area;          ///< 1 / sum W, the particle itself counted [m^2]
    std::vector<Star> star;            ///< of particles near films of other regions, nothing elsewhere
    std::vector<Tensor> gradient_map;  ///< makes gradients of linear fields exact, and tangent: see gradient()
    std::vector<Tensor> mirrored_map;  ///< the same with what lies beyond rims; empty where there are none

    std::size_t size() const { return normal.size(); }
};

/// Neighbors, patches with normals whose sign follows the frame normals, areas. [method sheet 4, 16.1]
/// @param rims  that hold the films, where they are now
Geometry geometry_of(const CoarseParticles& coarse, double support_radius, std::span<const RimPiece> rims = {});

}  // namespace lamella::melp
