#include "lamella/measure/film_mesh.h"

#include "lamella/core/error.h"
#include "lamella/mesh/edge_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace lamella::measure {
namespace {

using mesh::RegionId;
using mesh::RegionKind;

void check(const sim::Surface& surface) {
    if (surface.regions.size() != surface.triangles.size())
        throw InputError(fmt::format("{} pairs of regions for {} triangles", surface.regions.size(),
                                     surface.triangles.size()));
    for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
        const auto& t = surface.triangles[f];
        for (const std::uint32_t v : t)
            if (v >= surface.position.size())
                throw InputError(fmt::format("triangle {} refers to vertex {} of {}", f, v, surface.position.size()));
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) throw InputError(fmt::format("triangle {} has a vertex twice", f));
        const auto& [back, front] = surface.regions[f];
        if (back < 0 || front < 0)
            throw InputError(fmt::format("triangle {} lies between regions {} and {}", f, back, front));
    }
    for (std::size_t v = 0; v < surface.position.size(); ++v)
        for (const double x : surface.position[v].v)
            if (!std::isfinite(x)) throw InputError(fmt::format("vertex {} is not at a finite place", v));
    for (const sim::Field& field : surface.vertex_fields)
        if (field.values.size() != surface.position.size() * static_cast<std::size_t>(field.components))
            throw InputError(fmt::format("field {} has {} values for {} vertices", field.name, field.values.size(),
                                         surface.position.size()));
}

/// Labels without gaps, so that one large number in a file takes no memory.
std::vector<std::int32_t> used_labels(const sim::Surface& surface) {
    std::vector<std::int32_t> labels{0};
    for (const auto& sides : surface.regions) labels.insert(labels.end(), sides.begin(), sides.end());
    std::ranges::sort(labels);
    labels.erase(std::ranges::unique(labels).begin(), labels.end());
    return labels;
}

/// The value of a region's field, or `otherwise` where the frame says nothing.
double region_value(const sim::Surface& surface, std::string_view name, std::int32_t label, double otherwise) {
    const sim::Field* field = surface.find_of_regions(name);
    const auto at = static_cast<std::size_t>(label);
    return field != nullptr && field->components == 1 && at < field->values.size() ? field->values[at] : otherwise;
}

/// Where a film ends its label cycle is open: marks the vertices there and the regions that leak.
void find_rims(mesh::FoamMesh& mesh, bool mark_wires, bool mark_regions) {
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        std::map<RegionId, int> sum;  // what enters a region's surface along the edge must leave it
        for (const mesh::EdgeUse& use : edges.of(e)) {
            const mesh::Face& face = mesh.faces[use.face];
            sum[face.back] += use.forward ? 1 : -1;
            sum[face.front] -= use.forward ? 1 : -1;
        }
        for (const auto& [region, count] : sum) {
            if (count == 0) continue;
            if (mark_regions) mesh.regions[region].kind = RegionKind::kOpen;
            if (mark_wires) mesh.on_wire[edges.edge[e].a] = mesh.on_wire[edges.edge[e].b] = 1;
        }
    }
}

bool shares_vertices(const sim::Surface& surface) {
    std::vector<std::uint8_t> seen(surface.position.size(), 0);
    for (const auto& triangle : surface.triangles)
        for (const std::uint32_t v : triangle)
            if (seen[v]++ != 0) return true;
    return surface.triangles.size() < 2;
}

}  // namespace

FilmMesh film_mesh(const sim::Surface& surface) {
    check(surface);
    FilmMesh films;
    films.label = used_labels(surface);
    films.connected = shares_vertices(surface);
    mesh::FoamMesh& mesh = films.mesh;

    const sim::Field* on_wire = surface.find_of_vertices("on_wire");
    if (on_wire != nullptr && on_wire->components != 1) on_wire = nullptr;
    for (std::size_t v = 0; v < surface.position.size(); ++v)
        mesh.add_vertex(surface.position[v], on_wire != nullptr && on_wire->values[v] != 0.0);
    const auto region = [&](std::int32_t label) {
        return RegionId{static_cast<std::uint32_t>(std::ranges::lower_bound(films.label, label) - films.label.begin())};
    };
    for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
        const auto& t = surface.triangles[f];
        mesh.add_face(mesh::VertexId{t[0]}, mesh::VertexId{t[1]}, mesh::VertexId{t[2]}, region(surface.regions[f][0]),
                      region(surface.regions[f][1]));
    }
    const bool told = surface.find_of_regions("closed") != nullptr;
    for (const std::int32_t label : films.label) {
        const bool closed = label != 0 && region_value(surface, "closed", label, 1.0) != 0.0;
        mesh.regions.push_back({closed ? RegionKind::kClosed : RegionKind::kOpen,
                                region_value(surface, "target_volume", label, 0.0)});
    }
    if (films.connected && (!told || on_wire == nullptr)) find_rims(mesh, on_wire == nullptr, !told);
    return films;
}

}  // namespace lamella::measure
