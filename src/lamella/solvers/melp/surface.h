#pragma once

#include "lamella/solvers/melp/geometry.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::melp {

/// Triangles between coarse particles, indices of them; seen from where the normals point they turn counterclockwise.
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// The surface that the coarse particles lie on, rebuilt from nothing but their places and normals:
///
///   - each particle finds the Delaunay triangles around it among its neighbors, laid into its tangent plane;
///   - triangles that all three corners found are taken, then those that two found where their edges are still free;
///   - holes of up to eight edges that remain where layouts are nearly square are closed by triangles around a corner.
///
/// Of an even layout on a closed surface no edge stays open (open_edges); a real hole in a film stays one.
Triangles surface_triangles(const CoarseParticles& coarse, const Geometry& geometry);

/// Edges that belong to one triangle only.
std::size_t open_edges(const Triangles& triangles);

/// A third of the volume between `center` and the triangles that particle i makes with the neighbors its Voronoi cell
/// touches: summed over a closed film every triangle counts once [m^3]. Triangles bulge as their corners' normals say:
/// a quadratic with the curvatures kappa along the edges stands area * sum kappa length^2 / 24 above its corners'
/// plane. Right at folds too, where areas from kernels are not.
double star_volume(const CoarseParticles& coarse, const Geometry& geometry, std::size_t i, const Vec3& center);

/// Area of the Voronoi cell of particle i among its neighbors, in its tangent plane [m^2]: how fast the volume under it
/// grows along its normal. Right at folds too, and steady when triangles change.
double cell_area(const CoarseParticles& coarse, const Geometry& geometry, std::size_t i);

}  // namespace lamella::melp
