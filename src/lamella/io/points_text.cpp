// The two text formats of points: extended XYZ [https://github.com/libAtoms/extxyz] as OVITO and ASE read it, and CSV.

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/text_rows.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ostream>

namespace lamella::io {
namespace {

void check_has_points(const sim::Frame& frame, const char* format) {
    detail::check_frame(frame);
    if (frame.points.empty() && !frame.surface.empty()) {
        throw InputError(fmt::format("{} holds points, and this frame has a surface only; ply holds both", format));
    }
}

void append_value(std::string& line, const sim::Field& field, std::size_t index) {
    const double value = field.values[index];
    if (field.integer) {
        line += std::to_string(detail::whole(value));
    } else {
        append_shortest(line, value);
    }
}

/// Position, radius and fields of point i, each value after `separator`.
void append_point(std::string& line, const sim::Points& points, std::size_t i, char separator) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0) line += separator;
        append_shortest(line, points.position[i][k]);
    }
    if (!points.radius.empty()) {
        line += separator;
        append_shortest(line, points.radius[i]);
    }
    for (const sim::Field& field : points.fields) {
        const auto width = static_cast<std::size_t>(field.components);
        for (std::size_t k = 0; k < width; ++k) {
            line += separator;
            append_value(line, field, i * width + k);
        }
    }
    line += '\n';
}

/// A name as the XYZ header can hold it: neither its separators nor quotes.
std::string xyz_word(std::string name) {
    const auto separates = [](char c) { return std::string_view(" :=\"'\\{}[],").find(c) != std::string_view::npos; };
    std::replace_if(name.begin(), name.end(), separates, '_');
    return name;
}

/// The column's name. OVITO takes `stress` and `strain` for six numbers, so full tensors get another name.
std::string xyz_name(const sim::Field& field) {
    if (field.name == "velocity" && field.components == 3) return "velo";
    if (field.components == 9 && (field.name == "stress" || field.name == "strain")) return field.name + "_tensor";
    return xyz_word(field.name);
}

std::string xyz_box(const sim::Box& box, const sim::Points& points) {
    Vec3 origin = box.origin;
    Vec3 lengths = box.lengths;
    if (box.dimension == 2) {
        const auto& radius = points.radius;
        const double largest = radius.empty() ? 0.0 : *std::max_element(radius.begin(), radius.end());
        lengths[2] = largest > 0.0 ? 2.0 * largest : std::min(lengths[0], lengths[1]);
        origin[2] -= 0.5 * lengths[2];
    }
    const auto text = [](const Vec3& v, std::size_t k) { return shortest_text(v[k]); };
    const auto flag = [&](std::size_t k) { return box.periodic[k] && (k < 2 || box.dimension == 3) ? 'T' : 'F'; };
    return fmt::format("Lattice=\"{} 0 0 0 {} 0 0 0 {}\" Origin=\"{} {} {}\" pbc=\"{} {} {}\" ", text(lengths, 0),
                       text(lengths, 1), text(lengths, 2), text(origin, 0), text(origin, 1), text(origin, 2), flag(0),
                       flag(1), flag(2));
}

std::string xyz_comment(const sim::Frame& frame) {
    const sim::Points& points = frame.points;
    std::string properties = "species:S:1:pos:R:3";
    std::string units = "pos " + xyz_word(points.length_unit);
    if (!points.radius.empty()) {
        properties += ":radius:R:1";
        units += ", radius " + xyz_word(points.length_unit);
    }
    for (const sim::Field& field : points.fields) {
        properties += fmt::format(":{}:{}:{}", xyz_name(field), field.integer ? 'I' : 'R', field.components);
        units += ", " + xyz_name(field) + " " + xyz_word(field.unit);
    }
    std::string scalars;
    for (const sim::Scalar& scalar : frame.scalars) {
        scalars += fmt::format(" {}={}", xyz_word(scalar.name), shortest_text(scalar.value));
        units += ", " + xyz_word(scalar.name) + " " + xyz_word(scalar.unit);
    }
    return fmt::format("{}Properties={} Time={} step={} solver={} units=\"Time {}, {}\"{}\n",
                       frame.box ? xyz_box(*frame.box, points) : std::string("pbc=\"F F F\" "), properties,
                       shortest_text(frame.time), frame.step, xyz_word(frame.solver), xyz_word(frame.time_unit), units,
                       scalars);
}

}  // namespace

void write_extended_xyz(std::ostream& out, const sim::Frame& frame) {
    check_has_points(frame, "xyz");
    out << frame.points.size() << '\n' << xyz_comment(frame);
    detail::write_rows(out, frame.points.size(), [&](std::string& line, std::size_t i) {
        line += "X ";  // no element: ASE's name for one, and a type like any other for OVITO
        append_point(line, frame.points, i, ' ');
    });
    detail::finish(out);
}

void write_points_csv(std::ostream& out, const sim::Frame& frame) {
    check_has_points(frame, "csv");
    const sim::Points& points = frame.points;
    std::string header;
    for (const char* axis : {"x", "y", "z"}) header += fmt::format("{}[{}],", axis, points.length_unit);
    if (!points.radius.empty()) header += fmt::format("radius[{}],", points.length_unit);
    for (const sim::Field& field : points.fields) {
        for (int k = 0; k < field.components; ++k) {
            header += fmt::format("{}[{}],", detail::component_name(field.name, field.components, k), field.unit);
        }
    }
    header.back() = '\n';
    out << header;
    detail::write_rows(out, points.size(),
                       [&](std::string& line, std::size_t i) { append_point(line, points, i, ','); });
    detail::finish(out);
}

}  // namespace lamella::io
