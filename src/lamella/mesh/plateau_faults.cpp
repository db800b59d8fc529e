#include "lamella/mesh/plateau_faults.h"

#include "lamella/mesh/vertex_regions.h"

namespace lamella::mesh {

PlateauFaults plateau_faults(const FoamMesh& mesh, const EdgeFaces& edges) {
    PlateauFaults faults;
    IdVector<VertexId, int> lines(mesh.position.size(), 0);
    IdVector<VertexId, std::uint8_t> crossed(mesh.position.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b, shift] = edges.edge[e];
        const bool on_wire = mesh.on_wire[a] != 0 && mesh.on_wire[b] != 0;
        const std::size_t films = edges.of(e).size();
        if (films < 3 || on_wire) continue;
        ++lines[a];
        ++lines[b];
        if (films == 3) continue;
        faults.edges.push_back(e);
        crossed[a] = crossed[b] = 1;
    }
    const VertexRegions regions = vertex_regions(mesh);
    for (const VertexId v : mesh.position.ids()) {
        const std::size_t around = regions.of(v).size();
        if (mesh.on_wire[v] != 0 || around == 0) continue;
        // In a periodic foam a bubble may meet itself: there fewer regions than sectors are no fault.
        const auto fits = [&](std::size_t sectors) { return mesh.periodic() ? around <= sectors : around == sectors; };
        const bool regular = lines[v] == 0 ? fits(2) : lines[v] == 2 ? fits(3) : lines[v] == 4 && fits(4);
        if (crossed[v] != 0 || !regular) faults.vertices.push_back(v);
    }
    return faults;
}

}  // namespace lamella::mesh
