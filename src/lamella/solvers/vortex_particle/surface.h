#pragma once

// The film as the flow sees it: oriented triangles, what lies beside each, and the slopes of the hat functions.

#include "lamella/core/vec.h"
#include "lamella/mesh/foam_mesh.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::vortex_particle {

inline constexpr std::int32_t kNoNeighbor = -1;
inline constexpr std::uint32_t kNoRegion = 0xffffffffU;
inline constexpr std::uint32_t kNoPartner = 0xffffffffU;

/// A triangle at a vertex, of which the vertex is corner k.
struct Incidence {
    std::uint32_t triangle;
    std::uint32_t k;
};

/// Where a vertex is.
enum class Place : std::uint8_t {
    kInside,
    kWall,   ///< flow along the wall only
    kStill,  ///< no flow: on a wall without slip, or where two walls meet at an angle
};

/// What lies beyond the end of a film.
enum class Opening : std::uint8_t {
    kNone,  ///< a wall, or more film
    kInflow,
    kOutflow,
};

/// One closed curve of walls and openings.
struct BoundaryLoop {
    std::uint32_t component;
    double length = 0.0;  ///< [m]
    Vec3 center;          ///< mean of its vertices
    bool outer = false;   ///< the longest of its component; the others are holes
};

/// An oriented triangle surface, flat or curved, with or without walls, of one or more connected components.
///
/// Corners run counterclockwise seen from the tip of the normal. J a = n x a turns a tangent vector by 90 degrees,
/// also counterclockwise.
struct Surface {
    // What lies beside what.
    std::vector<std::array<std::uint32_t, 3>> corner;
    std::vector<std::array<std::int32_t, 3>> neighbor;  ///< across the edge opposite to corner k, or kNoNeighbor
    std::vector<std::size_t> ring_start;                ///< #V + 1
    std::vector<Incidence> ring;                        ///< around each vertex, ordered by triangle
    std::vector<std::uint32_t> component;               ///< of each vertex
    std::vector<std::int32_t> loop;                     ///< of each vertex; -1: inside
    std::vector<BoundaryLoop> loops;
    std::uint32_t components = 0;
    std::vector<std::uint32_t> site;     ///< the vertex of the films' mesh that each vertex lies at
    std::vector<std::uint32_t> film;     ///< the face of the films' mesh that each triangle lies in
    std::vector<std::uint8_t> side;      ///< 0: it is the leaf of the region behind that face, 1: in front
    std::vector<std::uint32_t> region;   ///< the bubble around which it closes, or kNoRegion
    std::vector<std::uint32_t> partner;  ///< the other leaf of the same film, or kNoPartner
    std::vector<double> share;           ///< of the film: 1/2 where it has two leaves, else 1
    // Empty where films do not flow on into each other over triple lines.
    std::vector<std::uint32_t> joint;               ///< of each vertex: the first of those at the same place
    std::vector<std::array<std::int32_t, 3>> seam;  ///< of the edge opposite to corner k: index into `seams`, or -1
    std::vector<std::vector<Incidence>> seams;      ///< the edges, each opposite to corner k, that lie on one another

    // Empty in a film that nothing streams through.
    std::vector<std::array<Opening, 3>> opening;  ///< of the edge opposite to corner k
    std::vector<Opening> vertex_opening;          ///< of each vertex; where inflow meets outflow, outflow

    // Where it lies.
    std::vector<Vec3> position;
    std::vector<Vec3> normal;                    ///< of each triangle
    std::vector<double> area;                    ///< of each triangle [m^2]
    std::vector<std::array<Vec3, 3>> hat_slope;  ///< grad phi_k = n x e_k / (2 area) [1/m], e_k the edge opposite to k
    std::vector<Vec3> vertex_normal;             ///< mean of the triangles around, weighted with area
    std::vector<Place> place;                    ///< of each vertex
    std::vector<Vec3> wall_normal;     ///< of each vertex: out of the film, where place is kNoNeighbor; else 0
    std::vector<double> vertex_share;  ///< mean share of the triangles around each vertex
    std::vector<double> vertex_area;   ///< a third of the triangles around: sums to the area [m^2]
    double total_area = 0.0;
    double longest_edge = 0.0;  ///< [m]
    double mean_edge = 0.0;     ///< of equilateral triangles of the same number and area [m]

    std::size_t triangles() const { return corner.size(); }
    std::size_t vertices() const { return position.size(); }
    std::span<const Incidence> around(std::size_t v) const {
        return std::span(ring).subspan(ring_start[v], ring_start[v + 1] - ring_start[v]);
    }
    /// The edge opposite to corner k, counterclockwise [m].
    Vec3 edge(std::size_t t, std::size_t k) const {
        return position[corner[t][(k + 2) % 3]] - position[corner[t][(k + 1) % 3]];
    }
    /// Of an equilateral triangle of its area [m].
    double edge_length(std::size_t t) const { return std::sqrt(2.3094010767585034 * area[t]); }  // 4 / sqrt(3)
    bool jointed() const { return !joint.empty(); }
    /// The triangles across the edge opposite to corner k where films meet; none elsewhere, and itself is among them.
    std::span<const Incidence> meeting(std::size_t t, std::size_t k) const {
        if (!jointed() || seam[t][k] < 0) return {};
        return seams[static_cast<std::size_t>(seam[t][k])];
    }
    bool open() const { return !opening.empty(); }
    Opening opening_of(std::size_t t, std::size_t k) const { return open() ? opening[t][k] : Opening::kNone; }
    bool lets_out(std::size_t v) const { return open() && vertex_opening[v] == Opening::kOutflow; }
    Vec3 point(std::size_t t, const std::array<double, 3>& b) const {
        return b[0] * position[corner[t][0]] + b[1] * position[corner[t][1]] + b[2] * position[corner[t][2]];
    }
};

/// What walls do to the flow along them.
enum class Walls { kSlip, kNoSlip };

/// What films that meet in triple lines are to the flow.
enum class Junction {
    kLeaves,  ///< see leaves.h
    kSheets,  ///< see sheets.h
};

/// @param stream  the velocity with which film runs through it [m/s], in where it points into the film and out where it
///                points out; 0: it is closed
/// @throws InputError  films without bubbles that meet in a triple line, as leaves; films that cannot be oriented or
/// that
///                     fill space; a stream that does not run along a flat film and its walls
Surface surface_of(const mesh::FoamMesh& mesh,
                   Walls walls = Walls::kSlip,
                   const Vec3& stream = {},
                   Junction junction = Junction::kLeaves);

/// Where the surface lies when the vertices of the films' mesh have moved.
/// @throws NumericalError  a triangle has lost its area
void place(const IdVector<mesh::VertexId, Vec3>& position, Walls walls, Surface& s);

/// Gives all vertices at one place the sum of what they have.
void add_up_joints(const Surface& s, std::span<double> value);
/// Of each component, the first of those with which its films hang together.
std::vector<std::uint32_t> connected_components(const Surface& s);

/// Of the whole film whose leaves' thickness is given at vertices [m].
std::vector<double> whole_thickness(const Surface& s, std::span<const double> leaves);

/// Turns the tangent vector `u` of a surface with normal `from` into one of a surface with normal `to` by the smallest
/// rotation that does so.
Vec3 turned(const Vec3& u, const Vec3& from, const Vec3& to);

}  // namespace lamella::vortex_particle
