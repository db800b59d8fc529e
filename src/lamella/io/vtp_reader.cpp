// Reads the VTK files that vtp_writer.cpp writes; the dialect is described in detail/vtp_format.h. Everything that
// the XML claims is checked against the data before memory is taken for it.

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/vtk_array.h"
#include "lamella/io/detail/vtp_format.h"
#include "lamella/io/detail/xml.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

namespace lamella::io {
namespace {

using detail::XmlScanner;
using detail::XmlToken;

constexpr std::size_t kMostItems = std::size_t{1} << 40;
constexpr std::size_t kMostComponents = 1024;
constexpr std::size_t kLongestText = std::size_t{1} << 16;
constexpr double kLargestWhole = 9007199254740992.0;  // 2^53, see sim::Field

/// What the XML says of one data array.
struct ArrayTag {
    std::string section;  ///< the element it stands in: FieldData, PointData, CellData, Points, Verts, Polys
    std::map<std::string, std::string> attributes;
    std::string unit;

    /// The attribute, or "" when there is none.
    std::string get(const std::string& key) const {
        const auto it = attributes.find(key);
        return it == attributes.end() ? std::string() : it->second;
    }
    std::string name() const { return get("Name"); }
};

/// The XML part of the file.
struct Outline {
    std::size_t points = 0;  ///< surface vertices and points together
    std::size_t point_cells = 0;
    std::size_t triangles = 0;
    std::vector<ArrayTag> arrays;
};

std::optional<std::size_t> parse_count(const std::string& text) {
    std::size_t value = 0;
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    return result.ec == std::errc() && result.ptr == end && value <= kMostItems ? std::optional(value) : std::nullopt;
}

void check_root(const XmlScanner& xml, const XmlToken& root) {
    const auto attribute = [&](const char* key) {
        const auto it = root.attributes.find(key);
        return it == root.attributes.end() ? std::string() : it->second;
    };
    if (root.kind != XmlToken::Kind::kStart || root.name != "VTKFile" || attribute("lamella_frame").empty()) {
        throw xml.error("was not written by lamella: the root element is not a VTKFile with lamella_frame=\"1\"");
    }
    if (attribute("lamella_frame") != detail::kVtpVersion) {
        throw xml.error(fmt::format("has version \"{}\" of lamella's frame format; this program reads version {}",
                                    attribute("lamella_frame"), detail::kVtpVersion));
    }
    if (attribute("type") != "PolyData" || attribute("byte_order") != "LittleEndian" ||
        attribute("header_type") != "UInt64" || attribute("compressor") != detail::kCompressor) {
        throw xml.error("was changed since lamella wrote it: unexpected type, byte order, header type or compressor");
    }
}

std::size_t count_attribute(const XmlScanner& xml, const XmlToken& piece, const char* key) {
    const auto it = piece.attributes.find(key);
    const auto count = it == piece.attributes.end() ? std::nullopt : parse_count(it->second);
    if (!count) throw xml.error(fmt::format("{} is missing or not a possible number", key));
    return *count;
}

void read_piece(const XmlScanner& xml, const XmlToken& piece, Outline& outline) {
    outline.points = count_attribute(xml, piece, "NumberOfPoints");
    outline.point_cells = count_attribute(xml, piece, "NumberOfVerts");
    outline.triangles = count_attribute(xml, piece, "NumberOfPolys");
    if (outline.point_cells > outline.points) throw xml.error("there are more point cells than points");
}

/// Reads up to the start of the binary data, whose place is left as the scanner's rest().
Outline read_outline(XmlScanner& xml) {
    check_root(xml, xml.next());
    Outline outline;
    std::vector<std::string> open;
    for (;;) {
        XmlToken token = xml.next();
        switch (token.kind) {
            case XmlToken::Kind::kEndOfFile:
                throw xml.error("the file ends early: there is no data section");
            case XmlToken::Kind::kText: {
                const bool unit = !open.empty() && open.back() == "InformationKey" && !outline.arrays.empty();
                if (!unit) throw xml.error("text stands where lamella writes none");
                outline.arrays.back().unit = token.text;
                break;
            }
            case XmlToken::Kind::kEnd:
                if (open.empty() || open.back() != token.name) throw xml.error("the XML elements are not nested");
                open.pop_back();
                break;
            case XmlToken::Kind::kStart:
                if (token.name == "AppendedData") return outline;
                if (token.name == "Piece") read_piece(xml, token, outline);
                if (token.name == "DataArray" || token.name == "Array") {
                    outline.arrays.push_back({open.empty() ? "" : open.back(), std::move(token.attributes), {}});
                }
                if (!token.empty_element) open.push_back(std::move(token.name));
                if (open.size() > 8) throw xml.error("the XML elements are nested too deeply");
                break;
        }
    }
}

/// Fields arrive in the order of the file; their index in the frame is an attribute.
class FieldList {
public:
    void add(std::size_t index, sim::Field field) { fields_.emplace(index, std::move(field)); }
    std::vector<sim::Field> take() {
        std::vector<sim::Field> list;
        for (auto& [index, field] : fields_) list.push_back(std::move(field));
        return list;
    }

private:
    std::multimap<std::size_t, sim::Field> fields_;
};

/// Turns the arrays of a file into a frame, one after the other.
class FrameBuilder {
public:
    FrameBuilder(const Outline& outline, std::string_view data, const std::string& file)
        : outline_(outline), data_(data, file), file_(file) {}

    sim::Frame build() {
        const std::map<std::string, void (FrameBuilder::*)(const ArrayTag&)> readers{
            {"FieldData", &FrameBuilder::read_frame_value}, {"PointData", &FrameBuilder::read_point_field},
            {"CellData", &FrameBuilder::read_face_field},   {"Points", &FrameBuilder::read_positions},
            {"Verts", &FrameBuilder::read_point_cells},     {"Polys", &FrameBuilder::read_triangles}};
        for (const ArrayTag& tag : outline_.arrays) {
            const auto reader = readers.find(tag.section);
            if (reader == readers.end()) throw error(tag, "stands where lamella writes no array");
            // One array starts where the one before ends: none is decompressed twice, so memory stays bounded.
            if (parse_count(tag.get("offset")) != data_.position()) throw error(tag, "is not where it should be");
            (this->*reader->second)(tag);
        }
        finish();
        return std::move(frame_);
    }

private:
    std::size_t vertices() const { return outline_.points - outline_.point_cells; }

    InputError error(const ArrayTag& tag, const std::string& what) const {
        return InputError({file_}, fmt::format("array \"{}\" in {} {}", tag.name(), tag.section, what));
    }

    std::size_t components(const ArrayTag& tag) const {
        const auto count = parse_count(tag.get("NumberOfComponents"));
        if (!count || *count < 1 || *count > kMostComponents)
            throw error(tag, "has an impossible number of components");
        return *count;
    }

    template <class Value>
    std::vector<Value> read(const ArrayTag& tag, const char* type, std::size_t count) {
        if (tag.get("type") != type) throw error(tag, fmt::format("is not of type {}", type));
        const std::string bytes = data_.read(tag.name(), count * sizeof(Value));
        std::vector<Value> values(count);
        if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

    std::string read_text(const ArrayTag& tag) {
        std::string text = data_.read_at_most(tag.name(), kLongestText);
        if (tag.get("type") != "String" || text.empty() || text.find('\0') != text.size() - 1) {
            throw error(tag, "is not a single text");
        }
        text.pop_back();
        return text;
    }

    /// A field with `count` items, its values not yet divided among surface and points.
    sim::Field read_field(const ArrayTag& tag, std::size_t count) {
        const std::size_t width = components(tag);
        sim::Field field{tag.name(), tag.unit, static_cast<int>(width), false, {}};
        if (tag.get("type") != "Int64") {
            field.values = read<double>(tag, "Float64", count * width);
            return field;
        }
        field.integer = true;
        const auto values = read<std::int64_t>(tag, "Int64", count * width);
        field.values.assign(values.begin(), values.end());
        const auto too_large = [](double v) { return v < -kLargestWhole || v > kLargestWhole; };
        if (std::any_of(field.values.begin(), field.values.end(), too_large)) {
            throw error(tag, "holds a whole number beyond 2^53");
        }
        return field;
    }

    /// The items [begin, end) of a field.
    static sim::Field slice(const sim::Field& field, std::size_t begin, std::size_t end) {
        const auto at = [&](std::size_t i) {
            return field.values.begin() + static_cast<std::ptrdiff_t>(i * static_cast<std::size_t>(field.components));
        };
        return {field.name, field.unit, field.components, field.integer, std::vector<double>(at(begin), at(end))};
    }

    std::array<double, 3> read_triple(const ArrayTag& tag) {
        const auto v = read<double>(tag, "Float64", 3);
        return {v[0], v[1], v[2]};
    }

    sim::Box& box() { return frame_.box ? *frame_.box : frame_.box.emplace(); }

    void read_frame_value(const ArrayTag& tag) {
        const std::string name = tag.name();
        if (!tag.get("scalar").empty()) {
            const double value = read<double>(tag, "Float64", 1)[0];
            frame_.scalars.push_back({name, tag.unit, value, tag.get("text")});
        } else if (!tag.get("region_field").empty()) {
            read_region_field(tag);
        } else if (name == detail::kTimeValue) {
            frame_.time = read<double>(tag, "Float64", 1)[0];
        } else if (name == "step") {
            frame_.step = read<std::int64_t>(tag, "Int64", 1)[0];
        } else if (name == "solver") {
            frame_.solver = read_text(tag);
        } else if (name == "time_unit") {
            frame_.time_unit = read_text(tag);
        } else if (name == "length_unit") {
            frame_.points.length_unit = read_text(tag);
        } else if (name == detail::kSolidCenter || name == detail::kSolidRadius) {
            read_solids(tag);
        } else {
            read_box_value(tag);
        }
    }

    /// Centers, then radii.
    void read_solids(const ArrayTag& tag) {
        const auto count = parse_count(tag.get("NumberOfTuples"));
        const bool centers = tag.name() == detail::kSolidCenter;
        if (!count || *count == 0 || (centers ? !frame_.solids.empty() : frame_.solids.size() != *count))
            throw error(tag, "does not fit to the other solids");
        const auto values = read<double>(tag, "Float64", (centers ? 3 : 1) * *count);
        if (centers) frame_.solids.resize(*count);
        for (std::size_t i = 0; i < *count; ++i) {
            if (centers)
                frame_.solids[i].center = {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
            else
                frame_.solids[i].radius = values[i];
        }
    }

    void read_region_field(const ArrayTag& tag) {
        const auto index = parse_count(tag.get("region_field"));
        const auto count = parse_count(tag.get("NumberOfTuples"));
        if (!index || !count || !tag.name().starts_with(detail::kRegionPrefix)) throw error(tag, "is none of lamella's");
        sim::Field field = read_field(tag, *count);
        field.name.erase(0, detail::kRegionPrefix.size());
        region_fields_.add(*index, std::move(field));
    }

    void read_box_value(const ArrayTag& tag) {
        const std::string name = tag.name();
        if (name == "box_dimension") {
            const std::int64_t dimension = read<std::int64_t>(tag, "Int64", 1)[0];
            if (dimension != 2 && dimension != 3) throw error(tag, "is neither 2 nor 3");
            box().dimension = static_cast<int>(dimension);
        } else if (name == "box_origin" || name == "box_lengths") {
            const auto triple = read_triple(tag);
            (name == "box_origin" ? box().origin : box().lengths) = {{triple[0], triple[1], triple[2]}};
        } else if (name == "box_periodic") {
            const auto periodic = read<std::int32_t>(tag, "Int32", 3);
            for (std::size_t k = 0; k < 3; ++k) box().periodic[k] = periodic[k] != 0;
        } else {
            throw error(tag, "is none of lamella's");
        }
    }

    void read_point_field(const ArrayTag& tag) {
        sim::Field field = read_field(tag, outline_.points);
        const auto on_surface = parse_count(tag.get("surface_field"));
        const auto on_points = parse_count(tag.get("point_field"));
        if (!on_surface && !on_points) {
            if (tag.name() != "radius" || field.components != 1) throw error(tag, "is none of lamella's");
            frame_.points.radius = slice(field, vertices(), outline_.points).values;
        }
        if (on_surface) vertex_fields_.add(*on_surface, slice(field, 0, vertices()));
        if (on_points) point_fields_.add(*on_points, slice(field, vertices(), outline_.points));
    }

    void read_face_field(const ArrayTag& tag) {
        const std::size_t cells = outline_.point_cells + outline_.triangles;
        if (tag.name() == "region_back" || tag.name() == "region_front") {
            const std::size_t side = tag.name() == "region_back" ? 0 : 1;
            const auto labels = read<std::int32_t>(tag, "Int32", cells);
            frame_.surface.regions.resize(outline_.triangles);
            for (std::size_t i = 0; i < outline_.triangles; ++i) {
                frame_.surface.regions[i][side] = labels[outline_.point_cells + i];
            }
            sides_read_ |= 1U << side;
            return;
        }
        const auto index = parse_count(tag.get("face_field"));
        if (!index) throw error(tag, "is none of lamella's");
        face_fields_.add(*index, slice(read_field(tag, cells), outline_.point_cells, cells));
    }

    void read_positions(const ArrayTag& tag) {
        const auto values = read<double>(tag, "Float64", 3 * outline_.points);
        if (positions_read_) throw error(tag, "is there twice");
        for (std::size_t i = 0; i < outline_.points; ++i) {
            auto& list = i < vertices() ? frame_.surface.position : frame_.points.position;
            list.push_back({{values[3 * i], values[3 * i + 1], values[3 * i + 2]}});
        }
        positions_read_ = true;
    }

    void read_point_cells(const ArrayTag& tag) {
        const auto values = read<std::int64_t>(tag, "Int64", outline_.point_cells);
        const std::size_t first = tag.name() == "connectivity" ? vertices() : 1;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] != static_cast<std::int64_t>(first + i))
                throw error(tag, "does not list the points in order");
        }
    }

    void read_triangles(const ArrayTag& tag) {
        const bool ends = tag.name() == "offsets";
        const auto values = read<std::int64_t>(tag, "Int64", outline_.triangles * (ends ? 1 : 3));
        if (ends) {
            for (std::size_t i = 0; i < values.size(); ++i) {
                if (values[i] != static_cast<std::int64_t>(3 * (i + 1)))
                    throw error(tag, "holds other cells than triangles");
            }
            return;
        }
        frame_.surface.triangles.resize(outline_.triangles);
        const auto limit = static_cast<std::int64_t>(std::min(vertices(), std::size_t{1} << 32));
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] < 0 || values[i] >= limit) throw error(tag, "refers to a vertex that does not exist");
            frame_.surface.triangles[i / 3][i % 3] = static_cast<std::uint32_t>(values[i]);
        }
        triangles_read_ = true;
    }

    void finish() {
        const bool whole = positions_read_ && triangles_read_ && (outline_.triangles == 0 || sides_read_ == 3U);
        if (!whole) throw InputError({file_}, "lacks its positions, triangles or region labels");
        if (data_.rest() != "\n</AppendedData>\n</VTKFile>\n") {
            throw InputError({file_}, "does not end where its last array does");
        }
        frame_.surface.vertex_fields = vertex_fields_.take();
        frame_.surface.face_fields = face_fields_.take();
        frame_.surface.region_fields = region_fields_.take();
        frame_.points.fields = point_fields_.take();
        try {
            detail::check_frame(frame_);
        } catch (const InputError& contradiction) {
            throw InputError({file_}, contradiction.what());
        }
    }

    const Outline& outline_;
    detail::VtkArrayReader data_;
    const std::string& file_;
    sim::Frame frame_;
    FieldList vertex_fields_, face_fields_, point_fields_, region_fields_;
    bool positions_read_ = false, triangles_read_ = false;
    unsigned sides_read_ = 0;
};

}  // namespace

sim::Frame read_vtp(const std::filesystem::path& path) {
    return parse_vtp(read_file(path, std::size_t{1} << 36), path.string());
}

sim::Frame parse_vtp(std::string_view contents, const std::string& name) {
    XmlScanner xml(contents, name);
    const Outline outline = read_outline(xml);
    const std::string_view rest = xml.rest();
    const std::size_t mark = rest.find_first_not_of(" \t\r\n");
    if (mark == std::string_view::npos || rest[mark] != '_') throw xml.error("the data section does not start with _");
    return FrameBuilder(outline, rest.substr(mark + 1), name).build();
}

}  // namespace lamella::io
