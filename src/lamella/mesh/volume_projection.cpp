#include "lamella/mesh/volume_projection.h"

#include "lamella/linalg/ldlt.h"
#include "lamella/linalg/symmetric_matrix.h"
#include "lamella/mesh/vertex_area.h"
#include "lamella/mesh/volume.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella::mesh {
namespace {

/// The closed regions, numbered one after the other.
struct ClosedRegions {
    std::vector<RegionId> region;
    IdVector<RegionId, int> number;  // -1: not closed
};

ClosedRegions closed_regions(const FoamMesh& mesh) {
    ClosedRegions closed{{}, IdVector<RegionId, int>(mesh.regions.size(), -1)};
    for (const RegionId r : mesh.regions.ids()) {
        if (mesh.regions[r].kind != RegionKind::kClosed) continue;
        closed.number[r] = static_cast<int>(closed.region.size());
        closed.region.push_back(r);
    }
    return closed;
}

/// sum over free vertices of (dV_r/dx . dV_s/dx) / A_v.
linalg::SymmetricMatrix gram_matrix(const FoamMesh& mesh,
                                    const ClosedRegions& closed,
                                    const VolumeGradient& slope,
                                    const IdVector<VertexId, double>& area) {
    linalg::Groups groups;
    for (const VertexId v : mesh.position.ids()) {
        for (const RegionId r : slope.entries.of(v)) groups.member.push_back(closed.number[r]);
        groups.close_group();
    }
    linalg::SymmetricMatrix gram = linalg::coupled(closed.region.size(), groups);
    for (const VertexId v : mesh.position.ids()) {
        if (mesh.on_wire[v] != 0 || area[v] == 0.0) continue;
        const std::size_t first = slope.entries.start[index(v)], last = slope.entries.start[index(v) + 1];
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = first; j <= i; ++j)
                gram.value[gram.slot(closed.number[slope.entries.region[i]], closed.number[slope.entries.region[j]])] +=
                    dot(slope.value[i], slope.value[j]) / area[v];
    }
    double largest = 0.0;
    for (std::size_t r = 0; r < gram.size(); ++r) largest = std::max(largest, gram.diagonal(r));
    for (std::size_t r = 0; r < gram.size(); ++r) gram.diagonal(r) += 1e-14 * largest;  // bubbles that cannot move
    return gram;
}

}  // namespace

VolumeProjection volume_projection(const FoamMesh& mesh, int rounds, double largest_change) {
    VolumeProjection result{IdVector<VertexId, Vec3>(mesh.position.size()), 0.0};
    const ClosedRegions closed = closed_regions(mesh);
    if (closed.region.empty()) return result;
    FoamMesh moved = mesh;
    for (int round = 0; round < rounds; ++round) {
        const IdVector<RegionId, double> volume = region_volumes(moved);
        std::vector<double> missing;
        double error = 0.0;
        for (const RegionId r : closed.region) {
            const double target = mesh.regions[r].target_volume;
            const double most = largest_change * std::abs(target);
            missing.push_back(std::clamp(target - volume[r], -most, most));
            if (target != 0.0) error = std::max(error, std::abs(target - volume[r]) / std::abs(target));
        }
        if (round == 0) result.error = error;
        if (error < 1e-14) break;
        const VolumeGradient slope = volume_gradient(moved);
        const IdVector<VertexId, double> area = barycentric_areas(moved);
        const linalg::SymmetricMatrix gram = gram_matrix(moved, closed, slope, area);
        linalg::Ldlt factors;
        factors.analyze(gram);
        if (!factors.factorize(gram)) break;
        factors.solve(missing);
        for (const VertexId v : mesh.position.ids()) {
            if (mesh.on_wire[v] != 0 || area[v] == 0.0) continue;
            Vec3 d;
            for (std::size_t i = slope.entries.start[index(v)]; i < slope.entries.start[index(v) + 1]; ++i)
                d += missing[static_cast<std::size_t>(closed.number[slope.entries.region[i]])] * slope.value[i];
            result.displacement[v] += d / area[v];
            moved.position[v] += d / area[v];
        }
    }
    return result;
}

}  // namespace lamella::mesh
