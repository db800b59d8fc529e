#pragma once

#include <vector>

#include "lamella/mesh/check.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/foam_mesh.h"

namespace lamella::mesh {

inline constexpr RegionId kNoRegion{0xffffffffU};  ///< a side of a face whose region is not known yet

/// Finds the regions of those sides of faces that are kNoRegion.
///
/// Around an edge, sorted by angle, each face and the next one look at the same gas; sides joined that way are one region.
/// An edge with one face ends a film: there its two sides stay apart. In each connected piece of the films one of the new
/// regions is the outside: the one that is turned inside out, else (flat films) the one in front of most faces. The others
/// are added to the mesh, open, in order of their first face. Normals need not agree with each other.
///
/// @param mesh  soundness is not needed, but every face must have three different vertices in range
/// @throws InputError  sides that look at the same gas but name different regions, a region that is named on some of its
///                     sides only, a film with the same gas on both sides (one that has one side only), unlabelled films
///                     inside a closed region of others; faces are named
void label_sides(FoamMesh& mesh, const EdgeFaces& edges, const ElementNames& names = {});

/// Of each region, whether films close it in: what enters its surface along any edge leaves there. Never the outside.
IdVector<RegionId, std::uint8_t> closed_in(const FoamMesh& mesh, const EdgeFaces& edges);

}  // namespace lamella::mesh
