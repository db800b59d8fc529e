#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/mesh/vertex_regions.h"

#include <vector>

// Mean curvature of the region surfaces, integrated: kappa_1 + kappa_2 (not its half), positive where the region bulges
// out. Seen from the two regions of a film it has opposite signs.

namespace lamella::mesh {

/// Integrated mean curvature of one region's surface along one edge, a < b.
struct EdgeCurvature {
    VertexId a;
    VertexId b;
    RegionId region;
    double value = 0.0;  ///< [m]
};

/// H_e^r = |e| theta for every edge and each region around it. [Da15, eq. 10]
///
/// theta in (-pi, pi] is the angle from the outward normal of r on one face to that on the other, about the edge,
/// positive if r is convex. Exactly two faces at the edge must touch r; an edge where r has more (films that cross) or
/// fewer (on a wire) has no entry for it.
/// @returns  entries ordered by (a, b, region)
std::vector<EdgeCurvature> edge_mean_curvatures(const FoamMesh& mesh);

/// H_v^r = 1/2 sum of H_e^r over the edges at v: the integral of kappa_1 + kappa_2 over the cell of v.
struct VertexCurvature {
    VertexRegions entries;
    std::vector<double> value;  ///< [m], one per entry
};

VertexCurvature vertex_mean_curvatures(const FoamMesh& mesh);

}  // namespace lamella::mesh
