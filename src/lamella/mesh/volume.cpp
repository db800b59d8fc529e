#include "lamella/mesh/volume.h"

#include "lamella/core/parallel.h"
#include "lamella/mesh/detail/triangle.h"

#include <array>
#include <optional>
#include <vector>

namespace lamella::mesh {
namespace {

IdVector<RegionId, Vec3> mean_corners(const FoamMesh& mesh) {
    IdVector<RegionId, Vec3> mean(mesh.regions.size());
    IdVector<RegionId, double> count(mesh.regions.size());
    for (const FaceId f : mesh.faces.ids())
        for (const RegionId r : {mesh.faces[f].back, mesh.faces[f].front})
            for (const Vec3& x : detail::triangle(mesh, f)) {
                mean[r] += x;
                count[r] += 1.0;
            }
    for (const RegionId r : mean.ids())
        if (count[r] > 0.0) mean[r] *= 1.0 / count[r];
    return mean;
}

}  // namespace

IdVector<RegionId, double> region_volumes(const FoamMesh& mesh) {
    const IdVector<RegionId, Vec3> center = mean_corners(mesh);
    IdVector<RegionId, double> volume(mesh.regions.size());
    const auto add_cone = [&](RegionId r, double sign, const detail::Triangle& x) {
        if (mesh.regions[r].kind != RegionKind::kClosed) return;
        volume[r] += sign * dot(x[0] - center[r], cross(x[1] - center[r], x[2] - center[r])) / 6.0;
    };
    for (const FaceId f : mesh.faces.ids()) {
        const detail::Triangle x = detail::triangle(mesh, f);
        add_cone(mesh.faces[f].back, 1.0, x);
        add_cone(mesh.faces[f].front, -1.0, x);
    }
    return volume;
}

VolumeGradient volume_gradient(const FoamMesh& mesh, WhichRegions which) {
    VolumeGradient gradient{vertex_regions(mesh, which), {}};
    gradient.value.resize(gradient.entries.region.size());
    struct Share {
        Vec3 third;  // of the face's area vector
        std::array<std::optional<std::size_t>, 3> back, front;
    };
    std::vector<Share> shares(mesh.faces.size());
    parallel_for(shares.size(), [&](std::size_t i) {
        const auto f = static_cast<FaceId>(i);
        const Face& face = mesh.faces[f];
        shares[i].third = detail::doubled_area_vector(detail::triangle(mesh, f)) / 6.0;
        for (std::size_t k = 0; k < 3; ++k) {
            shares[i].back[k] = gradient.entries.find(face.vertices[k], face.back);
            shares[i].front[k] = gradient.entries.find(face.vertices[k], face.front);
        }
    });
    for (const Share& share : shares)
        for (std::size_t k = 0; k < 3; ++k) {
            if (share.back[k]) gradient.value[*share.back[k]] += share.third;
            if (share.front[k]) gradient.value[*share.front[k]] -= share.third;
        }
    return gradient;
}

}  // namespace lamella::mesh
