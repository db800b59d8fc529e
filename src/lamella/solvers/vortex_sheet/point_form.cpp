#include "lamella/solvers/vortex_sheet/point_form.h"

#include "lamella/mesh/mean_curvature.h"
#include "lamella/mesh/vertex_area.h"

#include <algorithm>

namespace lamella::vortex_sheet {

using mesh::FoamMesh;
using mesh::VertexId;

std::vector<double> dihedral_pressures(const FoamMesh& mesh, const SheetTopology& topology, double surface_tension) {
    const mesh::VertexCurvature curvature = mesh::vertex_mean_curvatures(mesh);
    const IdVector<VertexId, double> area = mesh::barycentric_areas(mesh);
    std::vector<double> pressure(topology.size(), 0.0);
    for (const VertexId v : mesh.position.ids()) {
        const auto regions = static_cast<double>(topology.last(v) - topology.first(v));
        const double cell = 2.0 * area[v] / std::max(1.0, regions);
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i)
            if (const auto entry = curvature.entries.find(v, topology.entries.region[i]); entry && cell > 0.0)
                pressure[i] = surface_tension * curvature.value[*entry] / cell;
    }
    return pressure;
}

IdVector<VertexId, Vec3> point_velocity(const FoamMesh& mesh,
                                        const SheetTopology& topology,
                                        const SheetGeometry& geometry,
                                        const Circulation& phi,
                                        const spatial::VortexSumOptions& sum) {
    const std::vector<Vec3> strength = face_strengths(mesh, topology, phi);
    return IdVector<VertexId, Vec3>(
        spatial::vortex_sum(mesh.position.values(), geometry.barycenter, strength, sum, false).velocity);
}

void smooth_pairs(const FoamMesh& mesh, const SheetTopology& topology, double share, Circulation& phi) {
    const Circulation before = phi;
    std::vector<VertexId> around;
    for (const VertexId v : mesh.position.ids()) {
        if (topology.hold[v] != Hold::kFree) continue;
        around.clear();
        for (const mesh::Corner& corner : topology.corners.of(v))
            for (const VertexId w : mesh.faces[corner.face].vertices)
                if (w != v) around.push_back(w);
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
        const std::size_t first = topology.first(v), last = topology.last(v);
        const auto regions = static_cast<double>(last - first);
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = first; j < last; ++j) {
                double mean = 0.0, count = 0.0;
                for (const VertexId w : around) {
                    const auto a = topology.entries.find(w, topology.entries.region[i]);
                    const auto b = topology.entries.find(w, topology.entries.region[j]);
                    if (i == j || !a || !b) continue;
                    mean += before[*a] - before[*b];
                    count += 1.0;
                }
                if (count > 0.0) phi[i] += share / regions * (mean / count - (before[i] - before[j]));
            }
    }
}

}  // namespace lamella::vortex_sheet
