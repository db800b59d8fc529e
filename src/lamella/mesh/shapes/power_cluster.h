#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <cstdint>
#include <vector>

namespace lamella::mesh {

struct Ball {
    Vec3 center;
    double radius;
};

/// Balls of these radii in a compact heap: they start at random places and are drawn to the middle until they touch.
/// The same seed gives the same heap. @throws InputError  a radius that is not positive
std::vector<Ball> pack_balls(const std::vector<double>& radii, std::uint64_t seed);

/// A cluster of bubbles from balls: ball i gives region i + 1, the rest is outside.
///
/// A point belongs to the ball with the least power |x - c|^2 - r^2 among those with |x - c| < 1.3 r: the cells of the
/// power diagram, cut off outside. The labels are sampled on a body-centered cubic lattice and its tetrahedra are cut
/// where labels differ; faces with three labels and tetrahedra with four get a point of their own, so that the films
/// fit together whatever the labels. The triangles are uneven: let the tracker even them out.
///
/// @param edge_length  wanted length of an edge [m]
/// @returns target volumes are those of the mesh
/// @throws InputError  no balls, a bad size, a ball too small for the edge length, or more than 20 million lattice
/// points
FoamMesh power_cluster(const std::vector<Ball>& balls, double edge_length);

}  // namespace lamella::mesh
