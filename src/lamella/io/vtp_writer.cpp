// VTK XML PolyData: the dialect is described in detail/vtp_format.h.

#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/output_file.h"
#include "lamella/io/detail/vtk_array.h"
#include "lamella/io/detail/vtp_format.h"
#include "lamella/io/detail/xml.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

namespace lamella::io {
namespace {

using detail::TableColumn;
using detail::xml_escaped;

/// What the opening tag of a data array says beside its type and place.
struct ArrayTag {
    std::string name;
    std::string unit = {};  ///< "": none
    int components = 1;
    std::string attributes = {};  ///< further ones, each with a space before it
};

/// The two halves of the file: the XML, and the base64 data that its arrays point into.
class VtpText {
public:
    void line(const std::string& text) { xml_ += text + '\n'; }

    template <class Value>
    void array(const ArrayTag& tag, const char* type, std::span<const Value> values) {
        const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        open_array("DataArray", tag, type);
        for (int k = 0; tag.components > 1 && k < tag.components; ++k) {
            xml_ += fmt::format(" ComponentName{}=\"{}\"", k, detail::component_suffix(tag.components, k));
        }
        close_array("DataArray", tag.unit, bytes);
    }
    void array(const ArrayTag& tag, std::span<const double> values) { array(tag, "Float64", values); }
    void array(const ArrayTag& tag, std::span<const std::int64_t> values) { array(tag, "Int64", values); }
    void array(const ArrayTag& tag, std::span<const std::int32_t> values) { array(tag, "Int32", values); }

    /// A single string: VTK stores strings with a zero byte after each.
    void string(const std::string& name, const std::string& text) {
        open_array("Array", {.name = name, .attributes = " NumberOfTuples=\"1\""}, "String");
        close_array("Array", "", std::string_view(text.c_str(), text.size() + 1));
    }

    void column(const TableColumn& column, std::span<const double> values, const std::string& attributes) {
        const ArrayTag tag{column.name, column.unit, column.components, attributes};
        if (!column.integer) return array(tag, values);
        std::vector<std::int64_t> whole(values.size());
        std::transform(values.begin(), values.end(), whole.begin(), detail::whole);
        array(tag, std::span<const std::int64_t>(whole));
    }

    const std::string& xml() const { return xml_; }
    /// Array by array: one text that grows would need twice the room.
    const std::vector<std::string>& data() const { return data_; }

private:
    void open_array(const char* element, const ArrayTag& tag, const char* type) {
        xml_ += fmt::format("<{} type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{}", element, type,
                            xml_escaped(tag.name), tag.components, tag.attributes);
    }
    void close_array(const char* element, const std::string& unit, std::string_view bytes) {
        xml_ += fmt::format(" format=\"appended\" offset=\"{}\"", data_size_);
        detail::append_vtk_array(data_.emplace_back(), bytes);
        data_.back().shrink_to_fit();
        data_size_ += data_.back().size();
        if (unit.empty()) return line("/>");
        line(fmt::format("><InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey></{}>",
                         xml_escaped(unit), element));
    }

    std::string xml_;
    std::vector<std::string> data_;
    std::size_t data_size_ = 0;
};

std::string tuples(std::size_t count) { return fmt::format(" NumberOfTuples=\"{}\"", count); }

std::span<const double> flat(const std::vector<Vec3>& positions) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return {reinterpret_cast<const double*>(positions.data()), 3 * positions.size()};
}

void write_box(VtpText& out, const sim::Box& box, const std::string& length_unit) {
    const std::int64_t dimension = box.dimension;
    const std::array<std::int32_t, 3> periodic{box.periodic[0], box.periodic[1], box.periodic[2]};
    out.array({.name = "box_dimension", .attributes = tuples(1)}, std::span(&dimension, 1));
    out.array({"box_origin", length_unit, 3, tuples(1)}, std::span<const double>(box.origin.v));
    out.array({"box_lengths", length_unit, 3, tuples(1)}, std::span<const double>(box.lengths.v));
    out.array({.name = "box_periodic", .components = 3, .attributes = tuples(1)},
              std::span<const std::int32_t>(periodic));
}

void write_solids(VtpText& out, const std::vector<sim::Solid>& solids) {
    if (solids.empty()) return;
    std::vector<double> centers, radii;
    for (const sim::Solid& solid : solids) {
        centers.insert(centers.end(), solid.center.v, solid.center.v + 3);
        radii.push_back(solid.radius);
    }
    out.array({detail::kSolidCenter, "m", 3, tuples(solids.size())}, std::span<const double>(centers));
    out.array({detail::kSolidRadius, "m", 1, tuples(solids.size())}, std::span<const double>(radii));
}

void write_field_data(VtpText& out, const sim::Frame& frame) {
    out.line("<FieldData>");
    out.array({detail::kTimeValue, frame.time_unit, 1, tuples(1)}, std::span(&frame.time, 1));
    out.array({.name = "step", .attributes = tuples(1)}, std::span(&frame.step, 1));
    out.string("solver", frame.solver);
    out.string("time_unit", frame.time_unit);
    out.string("length_unit", frame.points.length_unit);
    if (frame.box) write_box(out, *frame.box, frame.points.length_unit);
    write_solids(out, frame.solids);
    for (std::size_t k = 0; k < frame.scalars.size(); ++k) {
        const sim::Scalar& scalar = frame.scalars[k];
        const std::string ours = fmt::format(" scalar=\"{}\" text=\"{}\"", k, xml_escaped(scalar.text));
        out.array({scalar.name, scalar.unit, 1, tuples(1) + ours}, std::span(&scalar.value, 1));
    }
    const std::vector<sim::Field>& of_regions = frame.surface.region_fields;
    for (std::size_t k = 0; k < of_regions.size(); ++k) {
        const sim::Field& field = of_regions[k];
        const TableColumn column{.name = detail::kRegionPrefix + field.name,
                                 .unit = field.unit,
                                 .components = field.components,
                                 .integer = field.integer};
        out.column(column, field.values,
                   tuples(frame.surface.regions_described()) + fmt::format(" region_field=\"{}\"", k));
    }
    out.line("</FieldData>");
}

void write_point_data(VtpText& out, const sim::Frame& frame) {
    out.line("<PointData>");
    std::vector<double> scratch;
    for (const TableColumn& column : detail::vertex_table(frame)) {
        std::string ours;
        if (column.first_index >= 0) ours += fmt::format(" surface_field=\"{}\"", column.first_index);
        if (column.second_index >= 0) ours += fmt::format(" point_field=\"{}\"", column.second_index);
        out.column(column, column.values(frame.surface.position.size(), frame.points.size(), scratch), ours);
    }
    out.line("</PointData>");
}

/// Cell data list the point cells first: VTK's order is Verts, Lines, Strips, Polys.
void write_cell_data(VtpText& out, const sim::Frame& frame) {
    const std::size_t points = frame.points.size();
    const sim::Surface& surface = frame.surface;
    out.line("<CellData>");
    for (const std::size_t side : {0U, 1U}) {
        std::vector<std::int32_t> labels(points, detail::kNoRegion);
        for (const auto& regions : surface.regions) labels.push_back(regions[side]);
        if (surface.empty()) break;
        out.array({.name = side == 0 ? "region_back" : "region_front"}, std::span<const std::int32_t>(labels));
    }
    std::vector<double> scratch;
    for (std::size_t k = 0; k < surface.face_fields.size(); ++k) {
        const sim::Field& field = surface.face_fields[k];
        const TableColumn column{.name = field.name,
                                 .unit = field.unit,
                                 .components = field.components,
                                 .integer = field.integer,
                                 .on_second = field.values};
        out.column(column, column.values(points, surface.triangles.size(), scratch),
                   fmt::format(" face_field=\"{}\"", k));
    }
    out.line("</CellData>");
}

void write_positions(VtpText& out, const sim::Frame& frame) {
    std::vector<double> both;
    std::span<const double> positions = flat(frame.points.position);
    if (!frame.surface.position.empty()) {
        const auto first = flat(frame.surface.position);
        both.assign(first.begin(), first.end());
        both.insert(both.end(), positions.begin(), positions.end());
        positions = both;
    }
    out.line("<Points>");
    out.array({"Points", frame.points.length_unit, 3}, positions);
    out.line("</Points>");
}

void write_cells(VtpText& out, const char* element, std::span<const std::int64_t> vertices, std::size_t per_cell) {
    std::vector<std::int64_t> ends(vertices.size() / per_cell);
    for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = static_cast<std::int64_t>((i + 1) * per_cell);
    out.line(fmt::format("<{}>", element));
    out.array({.name = "connectivity"}, vertices);
    out.array({.name = "offsets"}, std::span<const std::int64_t>(ends));
    out.line(fmt::format("</{}>", element));
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const sim::Frame& frame) {
    detail::check_frame(frame);
    const std::size_t vertices = frame.surface.position.size();
    std::vector<std::int64_t> point_cells(frame.points.size());
    std::iota(point_cells.begin(), point_cells.end(), static_cast<std::int64_t>(vertices));
    std::vector<std::int64_t> triangles;
    for (const auto& triangle : frame.surface.triangles)
        triangles.insert(triangles.end(), triangle.begin(), triangle.end());

    VtpText out;
    out.line("<?xml version=\"1.0\"?>");
    out.line(
        fmt::format("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
                    "compressor=\"{}\" lamella_frame=\"{}\">",
                    detail::kCompressor, detail::kVtpVersion));
    out.line("<PolyData>");
    write_field_data(out, frame);
    out.line(
        fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                    "NumberOfPolys=\"{}\">",
                    vertices + frame.points.size(), frame.points.size(), frame.surface.triangles.size()));
    write_point_data(out, frame);
    write_cell_data(out, frame);
    write_positions(out, frame);
    write_cells(out, "Verts", point_cells, 1);
    write_cells(out, "Polys", triangles, 3);
    out.line("</Piece>\n</PolyData>\n<AppendedData encoding=\"base64\">");

    detail::AtomicFile file(path);
    file.write(out.xml());
    file.write("_");
    for (const std::string& array : out.data()) file.write(array);
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
}

}  // namespace lamella::io
