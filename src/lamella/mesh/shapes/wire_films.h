#pragma once

#include "lamella/core/vec.h"
#include "lamella/mesh/foam_mesh.h"

namespace lamella::mesh {

// Films held by wires. Their rim vertices are on_wire. The two sides of a film are open regions: 0 on the side that
// the normal points to, 1 on the other. All throw InputError for a size that is not positive or that would give more
// than 20 million faces.

FoamMesh disk(const Vec3& center, const Vec3& normal, double radius, double edge_length);
/// Spanned by `u` and `v` [m] from the corner `origin`; the normal is u x v.
FoamMesh rectangle(const Vec3& origin, const Vec3& u, const Vec3& v, double edge_length);
/// Where a rectangle's edges are shorter: `edge_length` [m] in rows and columns within `radius` of `center` [m]; beyond,
/// they grow by a tenth of the distance.
struct Focus {
    Vec3 center;
    double radius = 0.0;
    double edge_length = 0.0;
};
FoamMesh rectangle(const Vec3& origin, const Vec3& u, const Vec3& v, double edge_length, const Focus& focus);
/// Bulges along `axis`, its rim is a circle around `center`.
FoamMesh hemisphere(const Vec3& center, const Vec3& axis, double radius, double edge_length);
/// A ball that a ring holds at its equator: region 1, of the volume of the exact ball, between the half that bulges along
/// `axis`, with region 0 before it, and the other, with the open region 2 behind it.
FoamMesh ball_in_ring(const Vec3& center, const Vec3& axis, double radius, double edge_length);
/// Between two rings of one radius, `separation` [m] apart along `axis`; region 1 is inside.
FoamMesh cylinder(const Vec3& center, const Vec3& axis, double radius, double separation, double edge_length);

enum class CatenoidBranch { kStable, kUnstable };
/// Radius of the neck of a catenoid between rings of `radius`, `separation` apart: the larger (stable) or smaller
/// root of radius = neck cosh(separation / (2 neck)).
/// @throws InputError  the rings are farther apart than 1.3254868 radii, where no catenoid exists
double catenoid_neck(double radius, double separation, CatenoidBranch branch);
/// Vertices on the exact catenoid; region 1 is inside.
FoamMesh catenoid(const Vec3& center,
                  const Vec3& axis,
                  double radius,
                  double separation,
                  double edge_length,
                  CatenoidBranch branch = CatenoidBranch::kStable);

enum class FrameShape { kTetrahedron, kCube, kOctahedron };
/// Films from every edge of a regular wire frame of edge length `frame_edge` [m] to its center: a cone. Behind every
/// face of the frame lies an open region of its own (1, 2, ...), which is also the air outside of that face.
/// The cone of the tetrahedron is at rest; those of the cube and the octahedron part.
FoamMesh frame_cone(FrameShape shape, const Vec3& center, double frame_edge, double edge_length);

}  // namespace lamella::mesh
