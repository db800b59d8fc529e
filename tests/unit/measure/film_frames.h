#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/sim/frame.h"

namespace lamella::test {

/// A mesh as the frame of a film solver, with what it knows of regions; pressures: 10 times the region's number.
inline sim::Frame film_frame(const mesh::FoamMesh& mesh) {
    sim::Frame frame;
    frame.solver = "toy";
    sim::Surface& surface = frame.surface;
    surface.position = mesh.position.values();
    for (const mesh::Face& face : mesh.faces) {
        surface.triangles.push_back({static_cast<std::uint32_t>(index(face.vertices[0])),
                                     static_cast<std::uint32_t>(index(face.vertices[1])),
                                     static_cast<std::uint32_t>(index(face.vertices[2]))});
        surface.regions.push_back(
            {static_cast<std::int32_t>(index(face.back)), static_cast<std::int32_t>(index(face.front))});
    }
    sim::Field wire{"on_wire", "-", 1, true, {}}, closed{"closed", "-", 1, true, {}},
        target{"target_volume", "m^3", 1, false, {}}, pressure{"pressure", "Pa", 1, false, {}};
    for (const std::uint8_t w : mesh.on_wire) wire.values.push_back(w);
    for (const mesh::RegionId r : mesh.regions.ids()) {
        closed.values.push_back(mesh.regions[r].kind == mesh::RegionKind::kClosed ? 1.0 : 0.0);
        target.values.push_back(mesh.regions[r].target_volume);
        pressure.values.push_back(10.0 * static_cast<double>(index(r)));
    }
    surface.vertex_fields = {wire};
    surface.region_fields = {closed, target, pressure};
    return frame;
}

}  // namespace lamella::test
