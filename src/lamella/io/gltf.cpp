// Binary glTF 2.0 (GLB): one mesh per film, for Blender, three.js, game engines. y points up there: (x, y, z) is
// written as (x, z, -y). [Khronos glTF 2.0; extensions KHR_materials_iridescence, KHR_materials_ior]

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/drawn_parts.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/text_rows.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>

namespace lamella::io {
namespace {

using detail::DrawnPart;

/// Text between quotes in JSON.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

/// The two chunks of the file while they grow.
class Glb {
public:
    /// Appends numbers as 32-bit floats; returns the accessor's number. Values that are not finite, which glTF cannot
    /// hold, become 0.
    std::size_t add_floats(const std::vector<double>& values, int components, bool bounds) {
        const auto n = static_cast<std::size_t>(components);
        std::vector<float> numbers;
        for (const double v : values) numbers.push_back(std::isfinite(v) ? static_cast<float>(v) : 0.0F);
        std::string extra;
        if (bounds) {
            std::vector<float> low(n, std::numeric_limits<float>::max()), high(n, std::numeric_limits<float>::lowest());
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                low[i % n] = std::min(low[i % n], numbers[i]);
                high[i % n] = std::max(high[i % n], numbers[i]);
            }
            extra = fmt::format(",\"min\":[{}],\"max\":[{}]", fmt::join(low, ","), fmt::join(high, ","));
        }
        return add(numbers.data(), sizeof(float) * numbers.size(), 34962, 5126, numbers.size() / n,
                   n == 1   ? "SCALAR"
                   : n == 2 ? "VEC2"
                            : "VEC3",
                   extra);
    }

    std::size_t add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
        return add(triangles.data(), sizeof(triangles[0]) * triangles.size(), 34963, 5125, 3 * triangles.size(),
                   "SCALAR", "");
    }

    /// Header, JSON and binary chunk.
    std::string file(const std::string& rest) const {
        std::string json = fmt::format(
            "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"lamella\"}},{},\"accessors\":[{}],"
            "\"bufferViews\":[{}],\"buffers\":[{{\"byteLength\":{}}}]}}",
            rest, accessors_, views_, bytes_.size());
        while (json.size() % 4 != 0) json += ' ';
        std::string out = "glTF";
        append(out, 2, 12 + 8 + json.size() + 8 + bytes_.size(), json.size());
        out += "JSON" + json;
        append(out, bytes_.size());
        out += std::string("BIN\0", 4) + bytes_;
        return out;
    }

private:
    template <class... Number>
    static void append(std::string& out, Number... numbers) {
        for (const std::size_t number : {static_cast<std::size_t>(numbers)...}) {
            if (number > std::numeric_limits<std::uint32_t>::max())
                throw InputError("GLB files end at 4 GiB; the frame needs more");
            const auto narrow = static_cast<std::uint32_t>(number);
            out.append(reinterpret_cast<const char*>(&narrow), sizeof narrow);
        }
    }

    std::size_t add(const void* data,
                    std::size_t size,
                    int target,
                    int type,
                    std::size_t count,
                    const char* shape,
                    const std::string& extra) {
        views_ += fmt::format("{}{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{},\"target\":{}}}",
                              number_ == 0 ? "" : ",", bytes_.size(), size, target);
        accessors_ += fmt::format("{}{{\"bufferView\":{},\"componentType\":{},\"count\":{},\"type\":\"{}\"{}}}",
                                  number_ == 0 ? "" : ",", number_, type, count, shape, extra);
        bytes_.append(static_cast<const char*>(data), size);
        return number_++;
    }

    std::string bytes_, views_, accessors_;
    std::size_t number_ = 0;
};

std::vector<double> y_up(std::vector<double> vectors) {
    for (std::size_t i = 0; i + 2 < vectors.size(); i += 3) {
        std::swap(vectors[i + 1], vectors[i + 2]);
        vectors[i + 2] = 0.0 - vectors[i + 2];  // without a sign at 0
    }
    return vectors;
}

std::vector<double> flattened(const std::vector<Vec3>& vectors) {
    std::vector<double> values;
    for (const Vec3& v : vectors) values.insert(values.end(), v.v, v.v + 3);
    return values;
}

/// "thickness_nm" becomes "_THICKNESS_NM": glTF's names for attributes of one's own.
std::string attribute_name(const std::string& name) {
    std::string out = "_";
    for (const char c : name)
        out += std::isalnum(static_cast<unsigned char>(c)) != 0
                   ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                   : '_';
    return out;
}

std::string add_field(Glb& glb, const DrawnPart& part, const sim::Field& field) {
    std::vector<double> values = detail::part_values(part, field);
    if (field.name == "color" && field.components == 3) {
        for (double& v : values) v = detail::linear_light(v);
        return fmt::format(",\"COLOR_0\":{}", glb.add_floats(values, 3, false));
    }
    if (field.components == 3) values = y_up(std::move(values));
    const std::string name = field.name == "normal" && field.components == 3 ? "NORMAL" : attribute_name(field.name);
    return fmt::format(",\"{}\":{}", name, glb.add_floats(values, field.components, false));
}

std::string mesh_json(Glb& glb, const DrawnPart& part, std::size_t material) {
    std::string attributes = fmt::format("\"POSITION\":{}", glb.add_floats(y_up(flattened(part.position)), 3, true));
    if (!part.normal.empty())
        attributes += fmt::format(",\"NORMAL\":{}", glb.add_floats(y_up(flattened(part.normal)), 3, false));
    for (const sim::Field& field : part.fields)
        if (field.components == 1 || field.components == 3) attributes += add_field(glb, part, field);
    const std::string faces =
        part.triangles.empty() ? "\"mode\":0" : fmt::format("\"indices\":{}", glb.add_triangles(part.triangles));
    const std::string extras =
        part.regions[0] < 0
            ? ""
            : fmt::format(",\"extras\":{{\"region_back\":{},\"region_front\":{}}}", part.regions[0], part.regions[1]);
    return fmt::format("{{\"name\":{},\"primitives\":[{{\"attributes\":{{{}}},{},\"material\":{}}}]{}}}",
                       quoted(part.name), attributes, faces, material, extras);
}

/// Clear films with interference for their mean thickness, where it is known; balls are plain, solids dark.
std::string material_json(const DrawnPart& part, const sim::Surface& surface) {
    if (part.name == "solids")
        return "{\"name\":\"solids\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.05,0.05,0.055,1],"
               "\"metallicFactor\":0,\"roughnessFactor\":0.3}}";
    const sim::Field* thickness = surface.find_of_vertices("thickness_nm");
    if (part.regions[0] < 0 || thickness == nullptr)
        return fmt::format(
            "{{\"name\":{},\"doubleSided\":true,\"pbrMetallicRoughness\":{{\"metallicFactor\":0,"
            "\"roughnessFactor\":0.4}}}}",
            quoted(part.name));
    double mean = 0.0;
    for (const double h : detail::part_values(part, *thickness)) mean += h / static_cast<double>(part.source.size());
    return fmt::format(
        "{{\"name\":{},\"doubleSided\":true,\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{{\"baseColorFactor\":"
        "[1,1,1,0.3],\"metallicFactor\":0,\"roughnessFactor\":0}},\"extensions\":{{\"KHR_materials_ior\":{{\"ior\":1."
        "33}},"
        "\"KHR_materials_iridescence\":{{\"iridescenceFactor\":1,\"iridescenceIor\":1.33,"
        "\"iridescenceThicknessMaximum\":{:.6g}}}}}}}",
        quoted(part.name), mean);
}

}  // namespace

void write_glb(std::ostream& out, const sim::Frame& frame) {
    detail::check_frame(frame);
    const std::vector<DrawnPart> parts = detail::drawn_parts(frame);
    if (parts.empty()) throw InputError("the frame has no films and no points: there is nothing to draw");
    Glb glb;
    std::string meshes, materials, nodes, numbers;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const char* comma = i == 0 ? "" : ",";
        meshes += comma + mesh_json(glb, parts[i], i);
        materials += comma + material_json(parts[i], frame.surface);
        nodes += fmt::format("{}{{\"name\":{},\"mesh\":{}}}", comma, quoted(parts[i].name), i);
        numbers += fmt::format("{}{}", comma, i);
    }
    const bool films = materials.find("KHR_materials_iridescence") != std::string::npos;
    out << glb.file(fmt::format(
        "{}\"scene\":0,\"scenes\":[{{\"nodes\":[{}],\"extras\":{{\"solver\":{},\"time\":{},\"time_unit\":{}}}}}],"
        "\"nodes\":[{}],"
        "\"meshes\":[{}],\"materials\":[{}]",
        films ? "\"extensionsUsed\":[\"KHR_materials_ior\",\"KHR_materials_iridescence\"]," : "", numbers,
        quoted(frame.solver), shortest_text(frame.time), quoted(frame.time_unit), nodes, meshes, materials));
    detail::finish(out);
}

}  // namespace lamella::io
