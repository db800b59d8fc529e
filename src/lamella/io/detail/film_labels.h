#pragma once

#include "lamella/mesh/check.h"
#include "lamella/mesh/foam_mesh.h"

#include <string>

namespace lamella::io::detail {

enum class Labels { kGiven, kMissing };

/// Refuses faces that no label could make sound: a vertex out of range or twice, no area, places that are not finite.
/// @throws InputError  "NAME: face 7 ..."
void require_proper_faces(const mesh::FoamMesh& mesh, const std::string& name, const mesh::ElementNames& names);

/// Completes a mesh from a file that says nothing of volumes: finds the regions where labels are missing, marks the ends of
/// films as wires, makes every region closed that films close in, at the volume it has, and audits the result.
/// @param mesh  vertices and faces; with kGiven also their labels
/// @throws InputError
void complete_films(mesh::FoamMesh& mesh, Labels labels, const std::string& name, const mesh::ElementNames& names);

}  // namespace lamella::io::detail
