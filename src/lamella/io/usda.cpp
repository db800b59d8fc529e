// USD as text (.usda): films as one Mesh with its fields as primvars, balls as Points with widths; for Houdini,
// Blender, Omniverse.

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/drawn_parts.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/text_rows.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <ostream>

namespace lamella::io {
namespace {

/// A name that USD takes: letters, digits and underscores.
std::string usd_name(const std::string& name) {
    std::string out;
    for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return std::isdigit(static_cast<unsigned char>(out[0])) != 0 ? "_" + out : out;
}

/// "    TYPE NAME = [...] (interpolation = ...)" with one row of `components` values for each item.
void write_list(std::ostream& out,
                const std::string& declaration,
                std::size_t count,
                int components,
                const std::function<double(std::size_t)>& value,
                const std::string& interpolation = {}) {
    out << "        " << declaration << " = [";
    const auto n = static_cast<std::size_t>(components);
    detail::write_rows(out, count, [&](std::string& row, std::size_t i) {
        if (i > 0) row += ", ";
        if (n == 1) return void(row += shortest_text(value(i)));
        for (std::size_t k = 0; k < n; ++k) row += (k == 0 ? "(" : ", ") + shortest_text(value(n * i + k));
        row += ')';
    });
    out << ']';
    if (!interpolation.empty()) out << " (\n            interpolation = \"" << interpolation << "\"\n        )";
    out << '\n';
}

void write_field(std::ostream& out, const sim::Field& field, std::size_t count, const char* interpolation) {
    if (field.components != 1 && field.components != 3) return;
    const auto value = [&](std::size_t i) { return field.values[i]; };
    if (field.name == "normal" && field.components == 3)
        return write_list(out, "normal3f[] normals", count, 3, value, interpolation);
    if (field.name == "color" && field.components == 3)
        return write_list(
            out, "color3f[] primvars:displayColor", count, 3,
            [&](std::size_t i) { return detail::linear_light(field.values[i]); }, interpolation);
    if (field.name == "velocity" && field.components == 3)
        return write_list(out, "vector3f[] velocities", count, 3, value);
    const char* type = field.components == 3 ? "vector3f" : field.integer ? "int" : "float";
    write_list(out, fmt::format("{}[] primvars:{}", type, usd_name(field.name)), count, field.components, value,
               interpolation);
}

void write_extent(std::ostream& out, const std::vector<Vec3>& places, double margin) {
    Vec3 low = places[0], high = places[0];
    for (const Vec3& p : places)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k] - margin);
            high[k] = std::max(high[k], p[k] + margin);
        }
    out << fmt::format("        float3[] extent = [({}, {}, {}), ({}, {}, {})]\n", low[0], low[1], low[2], high[0],
                       high[1], high[2]);
}

void write_places(std::ostream& out, const std::vector<Vec3>& places) {
    write_list(out, "point3f[] points", places.size(), 3, [&](std::size_t i) { return places[i / 3][i % 3]; });
}

void write_films(std::ostream& out, const sim::Surface& s) {
    out << "    def Mesh \"films\"\n    {\n";
    out << "        uniform bool doubleSided = 1\n        uniform token subdivisionScheme = \"none\"\n";
    write_extent(out, s.position, 0.0);
    write_list(out, "int[] faceVertexCounts", s.triangles.size(), 1, [](std::size_t) { return 3.0; });
    write_list(out, "int[] faceVertexIndices", 3 * s.triangles.size(), 1,
               [&](std::size_t i) { return static_cast<double>(s.triangles[i / 3][i % 3]); });
    write_places(out, s.position);
    for (const sim::Field& field : s.vertex_fields) write_field(out, field, s.position.size(), "vertex");
    for (const std::size_t side : {0U, 1U})
        write_list(
            out, side == 0 ? "int[] primvars:region_back" : "int[] primvars:region_front", s.regions.size(), 1,
            [&](std::size_t i) { return static_cast<double>(s.regions[i][side]); }, "uniform");
    for (const sim::Field& field : s.face_fields) write_field(out, field, s.triangles.size(), "uniform");
    out << "    }\n";
}

void write_balls(std::ostream& out, const sim::Points& points) {
    out << "    def Points \"bubbles\"\n    {\n";
    double largest = 0.0;
    for (const double r : points.radius) largest = std::max(largest, r);
    write_extent(out, points.position, largest);
    write_places(out, points.position);
    if (!points.radius.empty())
        write_list(
            out, "float[] widths", points.size(), 1, [&](std::size_t i) { return 2.0 * points.radius[i]; }, "vertex");
    for (const sim::Field& field : points.fields) write_field(out, field, points.size(), "vertex");
    out << "    }\n";
}

void write_solids(std::ostream& out, const std::vector<sim::Solid>& solids) {
    for (std::size_t i = 0; i < solids.size(); ++i) {
        const Vec3& c = solids[i].center;
        const std::string r = shortest_text(solids[i].radius);
        out << fmt::format("    def Sphere \"solid_{}\"\n    {{\n        double radius = {}\n", i, r)
            << fmt::format("        float3[] extent = [(-{0}, -{0}, -{0}), ({0}, {0}, {0})]\n", r)
            << "        color3f[] primvars:displayColor = [(0.05, 0.05, 0.055)]\n"
            << fmt::format("        double3 xformOp:translate = ({}, {}, {})\n", shortest_text(c[0]),
                           shortest_text(c[1]), shortest_text(c[2]))
            << "        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n    }\n";
    }
}

}  // namespace

void write_usda(std::ostream& out, const sim::Frame& frame) {
    detail::check_frame(frame);
    if (frame.surface.empty() && frame.points.empty())
        throw InputError("the frame has no films and no points: there is nothing to draw");
    out << "#usda 1.0\n(\n    defaultPrim = \"lamella\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\ndef Xform "
           "\"lamella\"\n{\n";
    out << "    custom string solver = \"" << usd_name(frame.solver) << "\"\n";
    out << "    custom double time = " << shortest_text(frame.time) << '\n';
    if (!frame.surface.empty()) write_films(out, frame.surface);
    if (!frame.points.empty()) write_balls(out, frame.points);
    write_solids(out, frame.solids);
    out << "}\n";
    detail::finish(out);
}

}  // namespace lamella::io
