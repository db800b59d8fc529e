// VTK XML PolyData: the dialect is described in detail/vtp_format.h.

#include "lamella/core/error.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/output_file.h"
#include "lamella/io/detail/vtk_array.h"
#include "lamella/io/detail/vtp_format.h"
#include "lamella/io/detail/xml.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
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

using Put = std::function<void(std::string_view)>;
using Contents = std::function<void(const Put&)>;

template <class Value>
std::string_view bytes_of(std::span<const Value> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// The file: the XML, then the base64 data that its arrays point into. First all arrays are declared, then their data
/// are written one after the other, and last the XML, for which room was left, with the places of the data in it.
class VtpFile {
public:
    explicit VtpFile(const std::filesystem::path& path) : file_(path) {}

    void line(const std::string& text) { xml_.back() += text + '\n'; }

    template <class Value>
    void array(const ArrayTag& tag, const char* type, std::size_t values, Contents contents) {
        open_array("DataArray", tag, type);
        for (int k = 0; tag.components > 1 && k < tag.components; ++k) {
            xml_.back() += fmt::format(" ComponentName{}=\"{}\"", k, detail::component_suffix(tag.components, k));
        }
        close_array("DataArray", tag.unit, values * sizeof(Value), std::move(contents));
    }
    /// Few values, which are kept.
    void array(const ArrayTag& tag, std::span<const double> values) { keep_array(tag, "Float64", values); }
    void array(const ArrayTag& tag, std::span<const std::int64_t> values) { keep_array(tag, "Int64", values); }
    void array(const ArrayTag& tag, std::span<const std::int32_t> values) { keep_array(tag, "Int32", values); }

    /// A single string: VTK stores strings with a zero byte after each.
    void string(const std::string& name, const std::string& text) {
        open_array("Array", {.name = name, .attributes = " NumberOfTuples=\"1\""}, "String");
        close_array("Array", "", text.size() + 1,
                    [text](const Put& put) { put(std::string_view(text.c_str(), text.size() + 1)); });
    }

    /// A column of `rows` rows whose values, as doubles, come from put().
    void column(const TableColumn& column, std::size_t rows, const std::string& attributes) {
        const ArrayTag tag{column.name, column.unit, column.components, attributes};
        array<double>(tag, column.integer ? "Int64" : "Float64", rows * static_cast<std::size_t>(column.components),
                      {});
        arrays_.back().whole = column.integer;
    }

    void kept_column(const TableColumn& column, std::span<const double> values, const std::string& attributes) {
        const ArrayTag tag{column.name, column.unit, column.components, attributes};
        if (!column.integer) return array(tag, values);
        std::vector<std::int64_t> whole(values.size());
        std::transform(values.begin(), values.end(), whole.begin(), detail::whole);
        array(tag, std::span<const std::int64_t>(whole));
    }

    /// Everything is declared.
    void begin_data() {
        const std::size_t longest_text = std::accumulate(
            arrays_.begin(), arrays_.end(), std::size_t{0},
            [](std::size_t sum, const Array& array) { return sum + detail::longest_vtk_array(array.bytes); });
        data_at_ = std::to_string(longest_text).size() * arrays_.size() + kDataTag.size();
        for (const std::string& text : xml_) data_at_ += text.size();
        end_ = data_at_;
        write_own_arrays();
    }

    /// The next values of columns; each call stays within one of them.
    void put(std::span<const double> values) {
        if (values.empty()) return;
        LAMELLA_ASSERT(writer_ && values.size_bytes() <= writer_->missing());
        if (!arrays_[current_].whole) {
            writer_->put(bytes_of(values));
        } else {
            std::vector<std::int64_t> whole(values.size());
            std::transform(values.begin(), values.end(), whole.begin(), detail::whole);
            writer_->put(bytes_of(std::span<const std::int64_t>(whole)));
        }
        write_own_arrays();
    }
    /// Values that the column under way still lacks.
    std::size_t missing() const { return writer_ ? writer_->missing() / sizeof(double) : 0; }

    void commit() {
        LAMELLA_ASSERT(current_ == arrays_.size());
        std::string xml;
        for (std::size_t a = 0; a < arrays_.size(); ++a) xml += xml_[a] + std::to_string(arrays_[a].offset);
        xml += xml_.back();
        xml += std::string(data_at_ - xml.size() - kDataTag.size(), ' ');
        xml += kDataTag;
        file_.write_at(0, xml);
        file_.write_at(end_, "\n</AppendedData>\n</VTKFile>\n");
        file_.commit();
    }

private:
    static constexpr std::string_view kDataTag = "<AppendedData encoding=\"base64\">\n_";

    struct Array {
        std::size_t bytes;
        Contents contents;       ///< none: comes from put()
        bool whole = false;      ///< what comes are doubles, what is stored are integers
        std::size_t offset = 0;  ///< in the data
    };

    template <class Value>
    void keep_array(const ArrayTag& tag, const char* type, std::span<const Value> values) {
        array<Value>(tag, type, values.size(),
                     [kept = std::vector<Value>(values.begin(), values.end())](const Put& put) {
                         put(bytes_of(std::span<const Value>(kept)));
                     });
    }
    void open_array(const char* element, const ArrayTag& tag, const char* type) {
        xml_.back() += fmt::format("<{} type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{}", element, type,
                                   xml_escaped(tag.name), tag.components, tag.attributes);
    }
    void close_array(const char* element, const std::string& unit, std::size_t bytes, Contents contents) {
        xml_.back() += " format=\"appended\" offset=\"";
        xml_.emplace_back("\"");
        arrays_.push_back({bytes, std::move(contents)});
        if (unit.empty()) return line("/>");
        line(fmt::format("><InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey></{}>",
                         xml_escaped(unit), element));
    }

    /// Ends the array that is complete, and writes those behind it whose contents are known.
    void write_own_arrays() {
        for (; current_ < arrays_.size(); ++current_) {
            Array& array = arrays_[current_];
            if (!writer_) {
                array.offset = end_ - data_at_;
                writer_.emplace(file_, end_, array.bytes);
                if (array.contents) array.contents([&](std::string_view bytes) { writer_->put(bytes); });
            }
            if (writer_->missing() > 0) return;
            end_ = writer_->finish();
            writer_.reset();
        }
    }

    detail::AtomicFile file_;
    std::vector<std::string> xml_{""};  ///< what stands before, between and behind the arrays' offsets
    std::vector<Array> arrays_;
    std::size_t data_at_ = 0;  ///< in the file
    std::size_t end_ = 0;      ///< of the arrays written so far
    std::size_t current_ = 0;
    std::optional<detail::VtkArrayWriter> writer_;  ///< of the current array
};

std::string tuples(std::size_t count) { return fmt::format(" NumberOfTuples=\"{}\"", count); }

std::span<const double> flat(const std::vector<Vec3>& positions) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return {reinterpret_cast<const double*>(positions.data()), 3 * positions.size()};
}

void write_box(VtpFile& out, const sim::Box& box, const std::string& length_unit) {
    const std::int64_t dimension = box.dimension;
    const std::array<std::int32_t, 3> periodic{box.periodic[0], box.periodic[1], box.periodic[2]};
    out.array({.name = "box_dimension", .attributes = tuples(1)}, std::span(&dimension, 1));
    out.array({"box_origin", length_unit, 3, tuples(1)}, std::span<const double>(box.origin.v));
    out.array({"box_lengths", length_unit, 3, tuples(1)}, std::span<const double>(box.lengths.v));
    out.array({.name = "box_periodic", .components = 3, .attributes = tuples(1)},
              std::span<const std::int32_t>(periodic));
}

void write_solids(VtpFile& out, const std::vector<sim::Solid>& solids) {
    if (solids.empty()) return;
    std::vector<double> centers, radii;
    for (const sim::Solid& solid : solids) {
        centers.insert(centers.end(), solid.center.v, solid.center.v + 3);
        radii.push_back(solid.radius);
    }
    out.array({detail::kSolidCenter, "m", 3, tuples(solids.size())}, std::span<const double>(centers));
    out.array({detail::kSolidRadius, "m", 1, tuples(solids.size())}, std::span<const double>(radii));
}

void write_field_data(VtpFile& out, const sim::Frame& frame) {
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
        out.kept_column(column, field.values,
                        tuples(frame.surface.regions_described()) + fmt::format(" region_field=\"{}\"", k));
    }
    out.line("</FieldData>");
}

/// Of `rows` rows; their values are put later, column by column.
void declare_point_data(VtpFile& out, const std::vector<TableColumn>& columns, std::size_t rows) {
    out.line("<PointData>");
    for (const TableColumn& column : columns) {
        std::string ours;
        if (column.first_index >= 0) ours += fmt::format(" surface_field=\"{}\"", column.first_index);
        if (column.second_index >= 0) ours += fmt::format(" point_field=\"{}\"", column.second_index);
        out.column(column, rows, ours);
    }
    out.line("</PointData>");
}

/// Cell data list the point cells first: VTK's order is Verts, Lines, Strips, Polys.
void write_cell_data(VtpFile& out, const sim::Frame& frame) {
    const std::size_t points = frame.points.size();
    const sim::Surface& surface = frame.surface;
    out.line("<CellData>");
    for (const std::size_t side : {0U, 1U}) {
        std::vector<std::int32_t> labels(points, detail::kNoRegion);
        for (const auto& regions : surface.regions) labels.push_back(regions[side]);
        if (surface.empty()) break;
        out.array({.name = side == 0 ? "region_back" : "region_front"}, std::span<const std::int32_t>(labels));
    }
    for (std::size_t k = 0; k < surface.face_fields.size(); ++k) {
        const sim::Field& field = surface.face_fields[k];
        const TableColumn column{.name = field.name,
                                 .unit = field.unit,
                                 .components = field.components,
                                 .integer = field.integer,
                                 .on_second = field.values};
        std::vector<double> scratch;
        out.kept_column(column, column.values(points, surface.triangles.size(), scratch),
                        fmt::format(" face_field=\"{}\"", k));
    }
    out.line("</CellData>");
}

/// Cells of `per_cell` vertices; vertex(n) is the n-th of all their corners.
template <class Vertex>
void write_cells(VtpFile& out, const char* element, std::size_t cells, std::size_t per_cell, Vertex&& vertex) {
    // Whole numbers that follow from their place are made piece by piece: there may be more than memory holds.
    const auto numbers = [](std::size_t count, auto value) {
        return [count, value](const Put& put) {
            constexpr std::size_t kPiece = std::size_t{1} << 17;
            std::vector<std::int64_t> piece;
            for (std::size_t first = 0; first < count; first += kPiece) {
                piece.resize(std::min(kPiece, count - first));
                for (std::size_t n = 0; n < piece.size(); ++n) piece[n] = static_cast<std::int64_t>(value(first + n));
                put(bytes_of(std::span<const std::int64_t>(piece)));
            }
        };
    };
    const std::size_t corners = cells * per_cell;
    out.line(fmt::format("<{}>", element));
    out.array<std::int64_t>({.name = "connectivity"}, "Int64", corners, numbers(corners, vertex));
    out.array<std::int64_t>({.name = "offsets"}, "Int64", cells,
                            numbers(cells, [per_cell](std::size_t i) { return (i + 1) * per_cell; }));
    out.line(fmt::format("</{}>", element));
}

/// The whole file but for the values of points and vertices: those of `columns`, then the coordinates, are to be put.
void declare(VtpFile& out, const sim::Frame& frame, const std::vector<TableColumn>& columns, std::size_t points) {
    const std::size_t vertices = frame.surface.position.size();
    const auto& triangles = frame.surface.triangles;
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
                    vertices + points, points, triangles.size()));
    declare_point_data(out, columns, vertices + points);
    write_cell_data(out, frame);
    out.line("<Points>");
    out.array<double>({"Points", frame.points.length_unit, 3}, "Float64", 3 * (vertices + points), {});
    out.line("</Points>");
    write_cells(out, "Verts", points, 1, [vertices](std::size_t n) { return vertices + n; });
    write_cells(out, "Polys", triangles.size(), 3, [&triangles](std::size_t n) { return triangles[n / 3][n % 3]; });
    out.line("</Piece>\n</PolyData>");
    out.begin_data();
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const sim::Frame& frame) {
    detail::check_frame(frame);
    const std::vector<TableColumn> columns = detail::vertex_table(frame);
    VtpFile out(path);
    declare(out, frame, columns, frame.points.size());
    std::vector<double> scratch;
    for (const TableColumn& column : columns)
        out.put(column.values(frame.surface.position.size(), frame.points.size(), scratch));
    out.put(flat(frame.surface.position));
    out.put(flat(frame.points.position));
    out.commit();
}

struct VtpStream::Impl {
    explicit Impl(const std::filesystem::path& path) : file(path) {}
    VtpFile file;
};

VtpStream::VtpStream(const std::filesystem::path& path, const sim::Frame& frame, std::size_t points, bool radii) {
    detail::check_frame(frame);
    LAMELLA_ASSERT(frame.surface.position.empty() && frame.surface.triangles.empty());
    impl_ = std::make_unique<Impl>(path);
    declare(impl_->file, frame, detail::vertex_table(frame, radii), points);
}

VtpStream::~VtpStream() = default;

void VtpStream::append(std::span<const double> values) {
    while (!values.empty()) {
        const std::size_t now = std::min(values.size(), impl_->file.missing());
        LAMELLA_ASSERT(now > 0);
        impl_->file.put(values.first(now));
        values = values.subspan(now);
    }
}

void VtpStream::commit() { impl_->file.commit(); }

}  // namespace lamella::io
