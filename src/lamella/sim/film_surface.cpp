#include "lamella/sim/film_surface.h"

#include <utility>

namespace lamella::sim {

Surface film_surface(const mesh::FoamMesh& mesh) {
    Surface surface;
    for (const mesh::Face& face : mesh.faces)
        surface.regions.push_back(
            {static_cast<std::int32_t>(index(face.back)), static_cast<std::int32_t>(index(face.front))});
    Field closed{"closed", "-", 1, true, {}}, target{"target_volume", "m^3", 1, false, {}};
    for (const mesh::Region& region : mesh.regions) {
        const bool bubble = region.kind == mesh::RegionKind::kClosed;
        closed.values.push_back(bubble ? 1.0 : 0.0);
        target.values.push_back(bubble ? region.target_volume : 0.0);
    }
    surface.region_fields = {std::move(closed), std::move(target)};
    if (mesh.periodic()) {
        for (const mesh::FaceId f : mesh.faces.ids())
            for (std::size_t k = 0; k < 3; ++k) surface.position.push_back(mesh.corner(f, k));
        for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) surface.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
        return surface;
    }
    surface.position = mesh.position.values();
    for (const mesh::Face& face : mesh.faces) {
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) corners[k] = static_cast<std::uint32_t>(index(face.vertices[k]));
        surface.triangles.push_back(corners);
    }
    surface.vertex_fields.push_back(
        {"on_wire", "-", 1, true, std::vector<double>(mesh.on_wire.begin(), mesh.on_wire.end())});
    return surface;
}

std::optional<Box> film_box(const mesh::FoamMesh& mesh) {
    if (!mesh.periodic()) return {};
    Box box;
    for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t k = 0; k < 3; ++k)
            if (k != a && mesh.period[a][k] != 0.0) return {};
        if (!(mesh.period[a][a] > 0.0)) return {};
        box.lengths[a] = mesh.period[a][a];
        box.periodic[a] = true;
    }
    return box;
}

}  // namespace lamella::sim
