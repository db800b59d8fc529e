#include "lamella/io/detail/film_labels.h"

#include "lamella/core/error.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/label_sides.h"
#include "lamella/mesh/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace lamella::io::detail {

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;

namespace {

void require_different_faces(const FoamMesh& mesh, const std::string& name, const mesh::ElementNames& names) {
    std::vector<std::pair<std::array<mesh::VertexId, 3>, mesh::FaceId>> faces;
    for (const mesh::FaceId f : mesh.faces.ids()) {
        faces.emplace_back(mesh.faces[f].vertices, f);
        std::sort(faces.back().first.begin(), faces.back().first.end());
    }
    std::sort(faces.begin(), faces.end());
    for (std::size_t k = 1; k < faces.size(); ++k)
        if (faces[k - 1].first == faces[k].first)
            throw InputError({name, 0, 0}, fmt::format("faces {} and {} have the same vertices",
                                                       names.of(faces[k - 1].second), names.of(faces[k].second)));
}

}  // namespace

void require_proper_faces(const FoamMesh& mesh, const std::string& name, const mesh::ElementNames& names) {
    if (mesh.faces.empty()) throw InputError({name, 0, 0}, "there are no faces");
    for (const mesh::VertexId v : mesh.position.ids())
        for (const double x : {mesh.position[v][0], mesh.position[v][1], mesh.position[v][2]})
            if (!std::isfinite(x))
                throw InputError({name, 0, 0}, fmt::format("vertex {} is not at a finite place", names.of(v)));
    for (const mesh::FaceId f : mesh.faces.ids()) {
        const auto& v = mesh.faces[f].vertices;
        for (const mesh::VertexId corner : v)
            if (index(corner) >= mesh.position.size())
                throw InputError({name, 0, 0}, fmt::format("face {} has vertex {}; there are {} vertices", names.of(f),
                                                           names.of(corner), mesh.position.size()));
        if (!mesh.periodic() && (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]))
            throw InputError({name, 0, 0}, fmt::format("face {} has a vertex twice", names.of(f)));
        const double area = norm(cross(mesh.corner(f, 1) - mesh.corner(f, 0), mesh.corner(f, 2) - mesh.corner(f, 0)));
        if (!(area > 0.0) || !std::isfinite(area))
            throw InputError({name, 0, 0}, fmt::format("face {} has no area", names.of(f)));
    }
    if (!mesh.periodic()) require_different_faces(mesh, name, names);  // in a torus images may tell them apart
}

namespace {

void hold_ends_of_films(FoamMesh& mesh, const mesh::EdgeFaces& edges) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
        std::map<RegionId, int> sum;
        for (const mesh::EdgeUse& use : edges.of(e)) {
            const mesh::Face& face = mesh.faces[use.face];
            sum[face.back] += use.forward ? 1 : -1;
            sum[face.front] -= use.forward ? 1 : -1;
        }
        const bool ends = std::any_of(sum.begin(), sum.end(), [](const auto& entry) { return entry.second != 0; });
        if (ends) mesh.on_wire[edges.edge[e].a] = mesh.on_wire[edges.edge[e].b] = 1;
    }
}

}  // namespace

void complete_films(FoamMesh& mesh, Labels labels, const std::string& name, const mesh::ElementNames& names) {
    require_proper_faces(mesh, name, names);
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    if (labels == Labels::kMissing) {
        mesh.regions.push_back({RegionKind::kOpen, 0.0});
        try {
            mesh::label_sides(mesh, edges, names);
        } catch (const InputError& error) {
            throw InputError({name, 0, 0}, error.what());
        }
        hold_ends_of_films(mesh, edges);
    }
    std::vector<bool> used(mesh.regions.size(), false);
    for (const mesh::Face& face : mesh.faces) used[index(face.back)] = used[index(face.front)] = true;
    const auto closed = mesh::closed_in(mesh, edges);
    for (const RegionId r : mesh.regions.ids()) {
        mesh.regions[r].kind = !used[index(r)] ? RegionKind::kGone : closed[r] != 0 ? RegionKind::kClosed : RegionKind::kOpen;
        if (r == mesh::kOutside) mesh.regions[r].kind = RegionKind::kOpen;
    }
    const auto volumes = mesh::region_volumes(mesh);
    for (const RegionId r : mesh.regions.ids()) {
        mesh::Region& region = mesh.regions[r];
        if (region.kind != RegionKind::kClosed) continue;
        if (!(volumes[r] > 0.0))
            throw InputError({name, 0, 0}, fmt::format("region {} has volume {:.3g}: its faces are turned inside out",
                                                       index(r), volumes[r]));
        region.target_volume = volumes[r];
    }
    mesh::require_sound(mesh, name, {.names = names});
}

}  // namespace lamella::io::detail
