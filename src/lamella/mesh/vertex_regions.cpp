#include "lamella/mesh/vertex_regions.h"

#include <algorithm>

namespace lamella::mesh {

VertexRegions vertex_regions(const FoamMesh& mesh, WhichRegions which) {
    return vertex_regions(mesh, vertex_corners(mesh), which);
}

VertexRegions vertex_regions(const FoamMesh& mesh, const VertexCorners& corners, WhichRegions which) {
    VertexRegions regions;
    regions.start.reserve(mesh.position.size() + 1);
    regions.start.push_back(0);
    std::vector<RegionId> row;
    for (const VertexId v : mesh.position.ids()) {
        row.clear();
        for (const Corner& corner : corners.of(v))
            for (const RegionId r : {mesh.faces[corner.face].back, mesh.faces[corner.face].front})
                if (which == WhichRegions::kAll || mesh.regions[r].kind == RegionKind::kClosed) row.push_back(r);
        std::ranges::sort(row);
        const auto repeated = std::unique(row.begin(), row.end());
        regions.region.insert(regions.region.end(), row.begin(), repeated);
        regions.start.push_back(regions.region.size());
    }
    return regions;
}

}  // namespace lamella::mesh
