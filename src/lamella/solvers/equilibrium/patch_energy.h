#pragma once

#include "lamella/core/vec.h"

#include <array>
#include <cstddef>

namespace lamella::equilibrium {

/// A 3 x 3 matrix by rows.
using Matrix3 = std::array<Vec3, 3>;

/// Shape functions of a patch and their slopes at one place.
struct ShapePoint {
    double weight;                           ///< in the rule of integration; they add up to 1/2
    std::array<double, 6> shape;             ///< N_i
    std::array<double, 6> along_u, along_v;  ///< dN_i/du, dN_i/dv
};

/// Shape functions of a patch with 3 or 6 nodes at (u, v) of the reference triangle, weight 0.
ShapePoint shape_at(int nodes_per_patch, double u, double v);
/// Where node k lies in the reference triangle.
std::array<double, 2> node_place(std::size_t k);

/// Area and volume of one patch with nodes x_i, and how they change with the nodes.
///
///   S = sum N_i x_i,  n = a x b with a = dS/du, b = dS/dv,  J = |n|
///   area = integral of J,   volume = integral of S . n / 3: of the cone from the origin
///
/// Flat patches are exact, quadratic ones use seven points, exact to degree 5 [Radon48]; the volume has degree 4.
struct PatchMeasures {
    double area = 0.0;
    double volume = 0.0;
    Vec3 area_vector;                  ///< integral of n
    std::array<Vec3, 6> area_slope{};  ///< d area / d x_i
    std::array<Vec3, 6> flux{};        ///< integral of N_i n: around a node of a closed surface they add up to dV/dx_i
};
PatchMeasures measure_patch(int nodes_per_patch, const std::array<Vec3, 6>& x);

/// Second derivatives of tension * area - pressure * volume by pairs of nodes: block (i, j), j <= i, at [i * 6 + j].
///
///   d2J/da2 = (|b|^2/J) N N^T,  d2J/db2 = (|a|^2/J) N N^T,  d2J/da db = -(a.b/J) N N^T - [N]x,  N = n / J
///
/// Of the volume's it is the symmetric part of d flux_i / d x_j: over a closed surface these add up to the second
/// derivative of its volume, and unlike those of S . n / 3 they do not depend on the origin, so that periodic foams need
/// no special care.
void patch_hessian(int nodes_per_patch,
                   const std::array<Vec3, 6>& x,
                   double tension,
                   double pressure,
                   std::array<Matrix3, 36>& block);

}  // namespace lamella::equilibrium
