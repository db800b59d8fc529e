// Binary PLY, the polygon format of Greg Turk that Blender, MeshLab and Houdini read.

#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/text_rows.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <optional>
#include <ostream>
#include <span>

namespace lamella::io {
namespace {

/// One property of a vertex or face: where its value for an item stands.
struct Property {
    std::string name;
    enum Type { kDouble, kInt, kByte } type = kDouble;
    std::span<const double> values;
    std::size_t stride = 1;
    std::size_t offset = 0;
};

/// Names that other programs know, for the components of the fields `normal` and `color`.
std::optional<std::string> known_name(const std::string& field, int components, int k) {
    constexpr std::array<const char*, 3> kNormal{"nx", "ny", "nz"}, kColor{"red", "green", "blue"};
    if (components != 3) return std::nullopt;
    if (field == "normal") return kNormal[static_cast<std::size_t>(k)];
    if (field == "color") return kColor[static_cast<std::size_t>(k)];
    return std::nullopt;
}

bool are_bytes(std::span<const double> values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return v >= 0.0 && v <= 255.0; });
}

bool fits_32_bit(std::span<const double> values) {
    constexpr double kLargest = std::numeric_limits<std::int32_t>::max();
    return std::all_of(values.begin(), values.end(), [](double v) { return v >= -kLargest - 1.0 && v <= kLargest; });
}

/// PLY separates words by spaces, and what follows a name there would be taken for more of the header.
std::string ply_word(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' '; }, '_');
    return name;
}

void add_properties(std::vector<Property>& list,
                    const std::string& name,
                    bool integer,
                    int components,
                    std::span<const double> values) {
    const bool color = integer && name == "color" && components == 3 && are_bytes(values);
    const Property::Type type = color                            ? Property::kByte
                                : integer && fits_32_bit(values) ? Property::kInt
                                                                 : Property::kDouble;
    for (int k = 0; k < components; ++k) {
        list.push_back({known_name(name, components, k).value_or(ply_word(detail::component_name(name, components, k))),
                        type, values, static_cast<std::size_t>(components), static_cast<std::size_t>(k)});
    }
}

template <class Value>
void append_bytes(std::string& out, Value value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_properties(std::string& out, const std::vector<Property>& properties, std::size_t item) {
    for (const Property& p : properties) {
        const double value = p.values[item * p.stride + p.offset];
        switch (p.type) {
            case Property::kByte:
                append_bytes(out, static_cast<std::uint8_t>(value));
                break;
            case Property::kInt:
                append_bytes(out, static_cast<std::int32_t>(value));
                break;
            case Property::kDouble:
                append_bytes(out, value);
                break;
        }
    }
}

std::string property_lines(const std::vector<Property>& properties) {
    std::string lines;
    constexpr std::array<const char*, 3> kTypes{"double", "int", "uchar"};
    for (const Property& p : properties) lines += fmt::format("property {} {}\n", kTypes[p.type], p.name);
    return lines;
}

std::string comments(const sim::Frame& frame, const std::vector<detail::TableColumn>& columns) {
    std::string text = fmt::format("comment lamella {} frame, time {} {}, step {}\n", frame.solver,
                                   shortest_text(frame.time), frame.time_unit, frame.step);
    text += fmt::format("comment unit x y z {}\n", frame.points.length_unit);
    for (const auto& column : columns) text += fmt::format("comment unit {} {}\n", ply_word(column.name), column.unit);
    for (const auto& field : frame.surface.face_fields) {
        text += fmt::format("comment unit face {} {}\n", ply_word(field.name), field.unit);
    }
    for (const auto& s : frame.scalars)
        text += fmt::format("comment {} {} {}\n", s.name, shortest_text(s.value), s.unit);
    return text;
}

}  // namespace

void write_ply(std::ostream& out, const sim::Frame& frame) {
    detail::check_frame(frame);
    const sim::Surface& surface = frame.surface;
    const std::size_t first = surface.position.size();
    const std::vector<detail::TableColumn> columns = detail::vertex_table(frame);
    std::vector<std::vector<double>> padded(columns.size());
    std::vector<Property> vertex_properties;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        add_properties(vertex_properties, columns[c].name, columns[c].integer, columns[c].components,
                       columns[c].values(first, frame.points.size(), padded[c]));
    }
    std::vector<Property> face_properties;
    for (const sim::Field& field : surface.face_fields) {
        add_properties(face_properties, field.name, field.integer, field.components, field.values);
    }

    const std::size_t vertices = first + frame.points.size();
    out << "ply\nformat binary_little_endian 1.0\n" << comments(frame, columns);
    out << "element vertex " << vertices << "\nproperty double x\nproperty double y\nproperty double z\n";
    out << property_lines(vertex_properties);
    out << "element face " << surface.triangles.size() << "\nproperty list uchar int vertex_indices\n"
        << "property int region_back\nproperty int region_front\n"
        << property_lines(face_properties) << "end_header\n";
    detail::write_rows(out, vertices, [&](std::string& row, std::size_t i) {
        const Vec3& x = i < first ? surface.position[i] : frame.points.position[i - first];
        for (std::size_t k = 0; k < 3; ++k) append_bytes(row, x[k]);
        append_properties(row, vertex_properties, i);
    });
    detail::write_rows(out, surface.triangles.size(), [&](std::string& row, std::size_t i) {
        append_bytes(row, std::uint8_t{3});
        for (const std::uint32_t vertex : surface.triangles[i]) append_bytes(row, vertex);
        for (const std::int32_t region : surface.regions[i]) append_bytes(row, region);
        append_properties(row, face_properties, i);
    });
    detail::finish(out);
}

}  // namespace lamella::io
