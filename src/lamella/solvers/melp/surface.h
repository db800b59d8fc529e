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

}  // namespace lamella::melp
