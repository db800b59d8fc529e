#pragma once

#include "lamella/geometry/curved_triangle.h"
#include "lamella/mesh/foam_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

// Angles of Plateau's laws: at rest three films meet at 120 degrees along a triple line, and four triple lines meet at
// acos(-1/3) = 109.47 degrees in a junction point.

namespace lamella::mesh {

/// How the direction of a film or line at its end is taken from the mesh.
enum class AngleMethod : std::uint8_t {
    kFlat,       ///< from the face or edge at the end: off by O(h) on curved films, even if they are at rest
    kQuadratic,  ///< from a quadratic patch or arc through the vertices near by: O(h^2)
    kWide,       ///< the same with the patches of films twice as wide: for films of unevenly spread vertices
};

/// The angles around one edge of a triple line, a < b.
struct TripleEdgeAngles {
    VertexId a;
    VertexId b;
    double length = 0.0;             ///< [m]
    std::array<RegionId, 3> region;  ///< around the edge, ascending
    std::array<double, 3> angle{};   ///< between the two films that bound region k, measured inside it [rad]; sum 2 pi
};

/// Angles between the films at every edge with exactly three faces and three regions, unless it lies on a wire (both
/// ends do). Each film's direction is that in which it leaves the middle of the edge, perpendicular to the edge.
///
/// kQuadratic: a film's heights over its face at the edge are fitted, by weighted least squares, with a quadratic
/// polynomial over the vertices of that film around the face. Where the film has too few vertices for that, the face
/// itself is taken.
/// kWide: over the vertices two edges around the face. Where vertices have slid along their films and lie off them by
/// O(h^2), as those of discrete films at rest do, the slope of the narrow patch is off by O(h), this one by about half.
/// @returns  ordered by (a, b)
std::vector<TripleEdgeAngles> triple_edge_angles(const FoamMesh& mesh, AngleMethod method);

/// The angles between the triple lines that meet in one point.
struct JunctionAngles {
    VertexId vertex;
    std::vector<double> angle;  ///< of each pair of lines [rad]
};

/// Angles at every vertex where three or more triple lines meet; six angles at a proper junction of four.
///
/// kQuadratic: a line's direction is the tangent of the parabola through its first three vertices; the first edge if
/// the line has only one.
/// @returns  ordered by vertex
std::vector<JunctionAngles> junction_angles(const FoamMesh& mesh, AngleMethod method);

/// The same from quadratic triangles, one for each face: films at the middle of each edge, lines at their junctions, along
/// the cubic that fits the nodes of their first two edges best. Where the triangles come from a solution of that order, the
/// angles are much closer than with kQuadratic.
std::vector<TripleEdgeAngles> triple_edge_angles(const FoamMesh& mesh,
                                                 const IdVector<FaceId, geometry::CurvedTriangle>& curved);
std::vector<JunctionAngles> junction_angles(const FoamMesh& mesh,
                                            const IdVector<FaceId, geometry::CurvedTriangle>& curved);

/// How far a set of angles is from a law.
struct AngleDeviation {
    double mean = 0.0;     ///< of |angle - law| [rad]
    double largest = 0.0;  ///< [rad]
};

/// Deviation from 120 degrees; the mean is weighted by edge length. All zero if there is no triple line.
AngleDeviation deviation_from_plateau(const std::vector<TripleEdgeAngles>& angles);

/// Deviation from acos(-1/3). All zero if there is no junction point.
AngleDeviation deviation_from_plateau(const std::vector<JunctionAngles>& angles);

}  // namespace lamella::mesh
