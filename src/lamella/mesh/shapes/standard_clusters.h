#pragma once

#include "lamella/mesh/foam_mesh.h"

namespace lamella::mesh {

/// The standard double bubble: two bubbles of given volumes at rest. Three spherical caps meet at 120 degrees on a
/// circle; 1/partition_radius = 1/radius2 - 1/radius1, so partition_curvature is 0 for equal volumes [Isenberg92].
struct DoubleBubble {
    double radius1 = 0.0, radius2 = 0.0;    ///< of the outer caps [m]
    double partition_curvature = 0.0;       ///< 1/radius2 - 1/radius1 [1/m]
    double circle_radius = 0.0;             ///< of the triple line [m]
    double center_distance = 0.0;           ///< of the centers of the outer caps [m]
    double area1 = 0.0, area2 = 0.0, partition_area = 0.0;  ///< [m^2]
    double volume1 = 0.0, volume2 = 0.0;    ///< [m^3]

    double area() const { return area1 + area2 + partition_area; }
};
/// The double bubble of these volumes [m^3], to round-off. @throws InputError  a volume that is not positive
DoubleBubble double_bubble_of_volumes(double volume1, double volume2);
/// The double bubble whose outer caps have these radii [m]. @throws InputError  a radius that is not positive
DoubleBubble double_bubble_of_radii(double radius1, double radius2);

/// A mesh of it: vertices on the exact caps, the triple line in the plane x = 0, bubble 1 at x < 0. Regions 1 and 2.
FoamMesh double_bubble(const DoubleBubble& shape, double edge_length);
/// Three (four) bubbles of equal volume, the power diagram of balls at the corners of a triangle (tetrahedron): close to
/// their resting shape, and with its symmetry. Regions 1 to 3 (4). @throws InputError  a size that is not positive
FoamMesh triple_bubble(double volume, double edge_length);
FoamMesh quadruple_bubble(double volume, double edge_length);

}  // namespace lamella::mesh
