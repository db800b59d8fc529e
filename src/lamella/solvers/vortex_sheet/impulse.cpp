#include "lamella/solvers/vortex_sheet/impulse.h"

#include <array>
#include <map>
#include <utility>

namespace lamella::vortex_sheet {
namespace {

using mesh::FaceId;
using mesh::FoamMesh;
using mesh::RegionId;
using mesh::VertexId;

double mean_jump(const SheetTopology& topology, const Circulation& phi, FaceId f) {
    return (jump(topology, phi, f, 0) + jump(topology, phi, f, 1) + jump(topology, phi, f, 2)) / 3.0;
}

/// x of matrix x = b for a 3 x 3 matrix of rows; zero where it is singular.
Vec3 solve3(const std::array<Vec3, 3>& m, const Vec3& b) {
    const Vec3 c0{{m[0][0], m[1][0], m[2][0]}}, c1{{m[0][1], m[1][1], m[2][1]}}, c2{{m[0][2], m[1][2], m[2][2]}};
    const double det = dot(c0, cross(c1, c2));
    if (det == 0.0) return {};
    return {{dot(b, cross(c1, c2)) / det, dot(c0, cross(b, c2)) / det, dot(c0, cross(c1, b)) / det}};
}

}  // namespace

Vec3 impulse(const FoamMesh& mesh,
             const SheetTopology& topology,
             const SheetGeometry& geometry,
             const Circulation& phi) {
    Vec3 sum;
    for (const FaceId f : mesh.faces.ids()) sum -= mean_jump(topology, phi, f) * geometry.area_vector[index(f)];
    return sum;
}

Vec3 angular_impulse(const FoamMesh& mesh,
                     const SheetTopology& topology,
                     const SheetGeometry& geometry,
                     const Circulation& phi) {
    Vec3 sum;
    for (const FaceId f : mesh.faces.ids()) {
        const auto& v = mesh.faces[f].vertices;
        Vec3 arm;  // integral of Gamma x over the face, over its area, both linear
        double total = 0.0;
        for (std::size_t k = 0; k < 3; ++k) total += jump(topology, phi, f, k);
        for (std::size_t k = 0; k < 3; ++k) arm += ((jump(topology, phi, f, k) + total) / 12.0) * mesh.position[v[k]];
        sum -= cross(arm, geometry.area_vector[index(f)]);
    }
    return sum;
}

ImpulseControl::ImpulseControl(const FoamMesh& mesh, const SheetTopology& topology, const SheetGeometry& geometry)
    : mesh_(mesh),
      topology_(topology),
      geometry_(geometry),
      held_(topology.clusters, 0),
      outer_(topology.clusters, mesh::kOutside),
      volume_(topology.clusters, 0.0),
      center_(topology.clusters),
      response_(topology.clusters) {
    std::vector<double> vertices(topology.clusters, 0.0);
    for (const VertexId v : mesh.position.ids()) {
        const std::uint32_t c = topology.cluster[v];
        if (topology.hold[v] != Hold::kFree) held_[c] = 1;
        center_[c] += mesh.position[v];
        vertices[c] += 1.0;
    }
    for (std::size_t c = 0; c < held_.size(); ++c) center_[c] = center_[c] / vertices[c];
    // The region around a cluster is the one that its films enclose with negative volume.
    std::map<std::pair<std::uint32_t, RegionId>, double> enclosed;
    auto back = enclosed.end(), front = enclosed.end();  // of the last face: the next one is mostly of the same film
    const auto seek = [&](auto& at, std::uint32_t c, RegionId r) -> double& {
        const std::pair key{c, r};
        if (at == enclosed.end() || at->first != key) at = enclosed.try_emplace(key, 0.0).first;
        return at->second;
    };
    for (const FaceId f : mesh.faces.ids()) {
        const std::uint32_t c = topology.cluster[mesh.faces[f].vertices[0]];
        const double cone = dot(geometry.barycenter[index(f)] - center_[c], geometry.area_vector[index(f)]) / 3.0;
        seek(back, c, mesh.faces[f].back) += cone;
        seek(front, c, mesh.faces[f].front) -= cone;
    }
    for (const auto& [key, volume] : enclosed)
        if (-volume > volume_[key.first]) {
            volume_[key.first] = -volume;
            outer_[key.first] = key.second;
        }
    for (const FaceId f : mesh.faces.ids()) {
        const std::uint32_t c = topology.cluster[mesh.faces[f].vertices[0]];
        const double sign = mesh.faces[f].front == outer_[c] ? 1.0 : mesh.faces[f].back == outer_[c] ? -1.0 : 0.0;
        if (sign == 0.0) continue;
        const Vec3 x = geometry.barycenter[index(f)] - center_[c];
        for (std::size_t j = 0; j < 3; ++j) response_[c][j] -= (sign * geometry.area_vector[index(f)][j]) * x;
    }
}

std::vector<Vec3> ImpulseControl::impulses(const Circulation& phi) const {
    std::vector<Vec3> sum(held_.size());
    for (const FaceId f : mesh_.faces.ids())
        sum[topology_.cluster[mesh_.faces[f].vertices[0]]] -=
            mean_jump(topology_, phi, f) * geometry_.area_vector[index(f)];
    return sum;
}

void ImpulseControl::add(std::span<const Vec3> change, Circulation& phi) const {
    std::vector<Vec3> slope(held_.size());
    for (std::size_t c = 0; c < held_.size(); ++c)
        if (held_[c] == 0) slope[c] = solve3(response_[c], change[c]);
    for (const VertexId v : mesh_.position.ids()) {
        const std::uint32_t c = topology_.cluster[v];
        if (held_[c] != 0) continue;
        const auto entry = topology_.entries.find(v, outer_[c]);
        if (entry) phi[*entry] += dot(slope[c], mesh_.position[v] - center_[c]);
    }
}

}  // namespace lamella::vortex_sheet
