#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace lamella::mesh {

/// What vertices and faces are called in messages: where they are empty, by their number from 0.
struct ElementNames {
    std::function<std::string(VertexId)> vertex;
    std::function<std::string(FaceId)> face;

    std::string of(VertexId v) const { return vertex ? vertex(v) : std::to_string(index(v)); }
    std::string of(FaceId f) const { return face ? face(f) : std::to_string(index(f)); }
};

/// What of a FoamMesh is examined.
struct CheckOptions {
    bool intersections = true;       ///< exact test of every pair of faces whose boxes meet
    std::size_t longest_list = 20;   ///< stop after so many faults
    ElementNames names;              ///< those of the file that the mesh came from
};

/// Everything that breaks a rule of FoamMesh, each a line that names the element: "face 12 has region 3 on both
/// sides", "edge 4-9 does not close region 1", "faces 7 and 8 cut each other at (0.1, 0, 0.3)". Empty: the mesh is sound.
///
/// Examined: finite positions; ids in range; column sizes; faces with a vertex twice or without area; faces with the
/// same vertices; region on both sides; the label cycle around every edge (open edges only between wire vertices);
/// vertices that no face uses; regions that are kClosed but have no face, an open rim or no positive volume; faces of
/// a region that is kGone; a periodic mesh with a singular cell; two faces that meet beyond what they share.
/// Never throws on bad content; memory O(#F).
std::vector<std::string> faults(const FoamMesh& mesh, const CheckOptions& options = {});

/// Pairs of faces that meet beyond what they share, tested exactly; counts up to `most`. Positions must be finite and
/// ids in range.
std::size_t intersecting_pairs(const FoamMesh& mesh, std::size_t most);

/// @throws InputError  "NAME: FAULT" of the first fault, and how many more there are
void require_sound(const FoamMesh& mesh, const std::string& name, const CheckOptions& options = {});

}  // namespace lamella::mesh
