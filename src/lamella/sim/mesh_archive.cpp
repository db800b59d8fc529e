#include "lamella/sim/mesh_archive.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <vector>

namespace lamella::sim {
namespace {

using mesh::FaceId;
using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;
using mesh::VertexId;

std::vector<double> flat(const IdVector<VertexId, Vec3>& vectors) {
    std::vector<double> values;
    values.reserve(3 * vectors.size());
    for (const Vec3& x : vectors) values.insert(values.end(), {x[0], x[1], x[2]});
    return values;
}

std::size_t read_count(StateReader& in, const std::string& name) {
    const std::int64_t count = in.read_integer(name);
    constexpr std::int64_t kMost = 1'000'000'000;
    if (count < 0 || count > kMost) throw InputError(fmt::format("{} = {} is no possible number", name, count));
    return static_cast<std::size_t>(count);
}

}  // namespace

void save_mesh(StateWriter& out, const std::string& group, const FoamMesh& mesh) {
    const auto name = [&](const char* column) { return group + "/" + column; };
    out.write_value(name("vertices"), static_cast<std::int64_t>(mesh.position.size()));
    out.write_value(name("faces"), static_cast<std::int64_t>(mesh.faces.size()));
    out.write_value(name("regions"), static_cast<std::int64_t>(mesh.regions.size()));
    out.write_value(name("periodic"), static_cast<std::int64_t>(mesh.periodic() ? 1 : 0));
    out.write(name("position"), std::span<const double>(flat(mesh.position)));
    const std::vector<std::int32_t> wires(mesh.on_wire.begin(), mesh.on_wire.end());
    out.write(name("on_wire"), std::span<const std::int32_t>(wires));
    std::vector<std::int32_t> corners, labels, kinds, images;
    for (const mesh::Face& face : mesh.faces) {
        for (const VertexId v : face.vertices) corners.push_back(static_cast<std::int32_t>(index(v)));
        labels.push_back(static_cast<std::int32_t>(index(face.back)));
        labels.push_back(static_cast<std::int32_t>(index(face.front)));
    }
    std::vector<double> targets;
    for (const mesh::Region& region : mesh.regions) {
        kinds.push_back(static_cast<std::int32_t>(region.kind));
        targets.push_back(region.target_volume);
    }
    for (const mesh::CornerImages& image : mesh.images)
        for (const auto& corner : image) images.insert(images.end(), corner.begin(), corner.end());
    std::vector<double> period;
    for (const Vec3& p : mesh.period) period.insert(period.end(), {p[0], p[1], p[2]});
    out.write(name("corners"), std::span<const std::int32_t>(corners));
    out.write(name("labels"), std::span<const std::int32_t>(labels));
    out.write(name("kinds"), std::span<const std::int32_t>(kinds));
    out.write(name("target_volumes"), std::span<const double>(targets));
    out.write(name("period"), std::span<const double>(period));
    if (mesh.periodic()) out.write(name("images"), std::span<const std::int32_t>(images));
}

FoamMesh load_mesh(StateReader& in, const std::string& group) {
    const auto name = [&](const char* column) { return group + "/" + column; };
    const std::size_t vertices = read_count(in, name("vertices"));
    const std::size_t faces = read_count(in, name("faces"));
    const std::size_t regions = read_count(in, name("regions"));
    const bool periodic = in.read_integer(name("periodic")) != 0;
    FoamMesh mesh;
    std::vector<double> values;
    std::vector<std::int32_t> numbers;
    in.read(name("position"), 3 * vertices, values);
    in.read(name("on_wire"), vertices, numbers);
    for (std::size_t v = 0; v < vertices; ++v)
        mesh.add_vertex({{values[3 * v], values[3 * v + 1], values[3 * v + 2]}}, numbers[v] != 0);
    in.read(name("kinds"), regions, numbers);
    in.read(name("target_volumes"), regions, values);
    for (std::size_t r = 0; r < regions; ++r) {
        if (numbers[r] < 0 || numbers[r] > static_cast<std::int32_t>(RegionKind::kGone))
            throw InputError(fmt::format("{}: region {} has no known kind", group, r));
        mesh.regions.push_back({static_cast<RegionKind>(numbers[r]), values[r]});
    }
    std::vector<std::int32_t> labels;
    in.read(name("corners"), 3 * faces, numbers);
    in.read(name("labels"), 2 * faces, labels);
    const auto checked = [&](std::int32_t id, std::size_t count, std::size_t face) {
        if (id < 0 || static_cast<std::size_t>(id) >= count)
            throw InputError(fmt::format("{}: face {} refers to element {} of {}", group, face, id, count));
        return static_cast<std::uint32_t>(id);
    };
    for (std::size_t f = 0; f < faces; ++f)
        mesh.add_face(VertexId{checked(numbers[3 * f], vertices, f)}, VertexId{checked(numbers[3 * f + 1], vertices, f)},
                      VertexId{checked(numbers[3 * f + 2], vertices, f)}, RegionId{checked(labels[2 * f], regions, f)},
                      RegionId{checked(labels[2 * f + 1], regions, f)});
    in.read(name("period"), 9, values);
    for (std::size_t k = 0; k < 9; ++k) mesh.period[k / 3][k % 3] = values[k];
    if (!periodic) return mesh;
    in.read(name("images"), 9 * faces, numbers);
    for (std::size_t f = 0; f < faces; ++f) {
        mesh::CornerImages image;
        for (std::size_t k = 0; k < 9; ++k) image[k / 3][k % 3] = static_cast<std::int8_t>(numbers[9 * f + k]);
        mesh.images.push_back(image);
    }
    return mesh;
}

}  // namespace lamella::sim
