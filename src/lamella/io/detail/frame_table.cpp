#include "lamella/io/detail/frame_table.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/io/detail/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace lamella::io::detail {
namespace {

constexpr double kLargestWhole = 9007199254740992.0;  // 2^53

bool holds_whole_numbers(const std::vector<double>& values) {
    constexpr int kYes = 1;  // not bool: the bits of a vector<bool> cannot be written from several threads
    constexpr int kNo = 0;
    const int whole_numbers = parallel_reduce(
        values.size(), kYes,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                if (!(std::abs(values[i]) <= kLargestWhole) || values[i] != std::trunc(values[i])) return kNo;
            }
            return kYes;
        },
        [](int a, int b) { return a & b; });
    return whole_numbers == kYes;
}

void check_name(const std::string& name, const std::string& unit, std::set<std::string>& used) {
    if (name.empty()) throw InputError("a frame holds a field or scalar without a name");
    if (!is_printable(name) || !is_printable(unit)) {
        throw InputError(fmt::format("the name or unit of \"{}\" is not one line of UTF-8", name));
    }
    if (!used.insert(name).second) throw InputError(fmt::format("a frame holds \"{}\" twice", name));
}

void check_fields(const std::vector<sim::Field>& fields, std::size_t count, std::set<std::string> used) {
    for (const sim::Field& field : fields) {
        check_name(field.name, field.unit, used);
        if (field.components < 1 || field.values.size() != count * static_cast<std::size_t>(field.components)) {
            throw InputError(fmt::format("field \"{}\" has {} values; {} items of {} components were expected",
                                         field.name, field.values.size(), count, field.components));
        }
        if (field.integer && !holds_whole_numbers(field.values)) {
            throw InputError(fmt::format("integer field \"{}\" holds a value that is not a whole number", field.name));
        }
    }
}

void check_surface(const sim::Surface& surface) {
    if (surface.regions.size() != surface.triangles.size()) {
        throw InputError(fmt::format("a surface has {} triangles but {} pairs of regions", surface.triangles.size(),
                                     surface.regions.size()));
    }
    for (const auto& triangle : surface.triangles) {
        if (*std::max_element(triangle.begin(), triangle.end()) >= surface.position.size()) {
            throw InputError(fmt::format("a triangle refers to vertex {} of {}",
                                         *std::max_element(triangle.begin(), triangle.end()), surface.position.size()));
        }
    }
    check_fields(surface.vertex_fields, surface.position.size(), {"radius"});
    check_fields(surface.face_fields, surface.triangles.size(), {"region_back", "region_front"});
    const std::size_t described = surface.regions_described();
    check_fields(surface.region_fields, described, {});
    if (surface.region_fields.empty()) return;
    for (const auto& sides : surface.regions)
        for (const std::int32_t region : sides)
            if (region < 0 || static_cast<std::size_t>(region) >= described)
                throw InputError(fmt::format("a triangle has region {} beside it, but the fields of regions tell of {}",
                                             region, described));
}

void check_solids(const std::vector<sim::Solid>& solids) {
    for (std::size_t i = 0; i < solids.size(); ++i) {
        const sim::Solid& solid = solids[i];
        if (!(std::isfinite(solid.center[0]) && std::isfinite(solid.center[1]) && std::isfinite(solid.center[2])) ||
            !(solid.radius > 0.0) || !std::isfinite(solid.radius))
            throw InputError(fmt::format("solid {} has no place or no size", i));
    }
}

TableColumn column_of(const sim::Field& field) {
    return {.name = field.name, .unit = field.unit, .components = field.components, .integer = field.integer};
}

}  // namespace

void check_frame(const sim::Frame& frame) {
    check_surface(frame.surface);
    const sim::Points& points = frame.points;
    if (!points.radius.empty() && points.radius.size() != points.size()) {
        throw InputError(fmt::format("{} radii for {} points", points.radius.size(), points.size()));
    }
    check_fields(points.fields, points.size(), {"radius"});
    check_solids(frame.solids);
    // What every frame file says about the frame itself.
    std::set<std::string> used{"TimeValue",    "step",       "solver",        "time_unit",
                               "length_unit",  "box_origin", "box_dimension", "box_lengths",
                               "box_periodic", kSolidCenter, kSolidRadius};
    for (const sim::Field& field : frame.surface.region_fields) used.insert(kRegionPrefix + field.name);
    for (const sim::Scalar& scalar : frame.scalars) {
        check_name(scalar.name, scalar.unit, used);
        if (!is_printable(scalar.text)) {
            throw InputError(fmt::format("the text of scalar \"{}\" is not one line of UTF-8", scalar.name));
        }
    }
    if (!is_printable(frame.solver) || !is_printable(frame.time_unit) || !is_printable(points.length_unit)) {
        throw InputError("the solver name or a unit of a frame is not one line of UTF-8");
    }
}

std::span<const double> TableColumn::values(std::size_t first, std::size_t second, std::vector<double>& scratch) const {
    const auto width = static_cast<std::size_t>(components);
    if (first == 0 && on_second.size() == second * width) return on_second;
    if (second == 0 && on_first.size() == first * width) return on_first;
    scratch.assign((first + second) * width, integer ? -1.0 : std::numeric_limits<double>::quiet_NaN());
    std::copy(on_first.begin(), on_first.end(), scratch.begin());
    std::copy(on_second.begin(), on_second.end(), scratch.begin() + static_cast<std::ptrdiff_t>(first * width));
    return scratch;
}

std::vector<TableColumn> vertex_table(const sim::Frame& frame, bool radii) {
    std::vector<TableColumn> columns;
    if (radii) {
        columns.push_back({.name = "radius", .unit = frame.points.length_unit, .on_second = frame.points.radius});
    }
    const std::vector<sim::Field>& on_surface = frame.surface.vertex_fields;
    for (std::size_t k = 0; k < on_surface.size(); ++k) {
        TableColumn& column = columns.emplace_back(column_of(on_surface[k]));
        column.on_first = on_surface[k].values;
        column.first_index = static_cast<int>(k);
    }
    for (std::size_t k = 0; k < frame.points.fields.size(); ++k) {
        const sim::Field& field = frame.points.fields[k];
        auto column = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == field.name; });
        if (column == columns.end()) column = columns.insert(column, column_of(field));
        if (column->unit != field.unit || column->components != field.components || column->integer != field.integer) {
            throw InputError(
                fmt::format("field \"{}\" differs in unit or shape between surface and points", field.name));
        }
        column->on_second = field.values;
        column->second_index = static_cast<int>(k);
    }
    return columns;
}

std::string component_suffix(int components, int k) {
    constexpr std::string_view kAxes = "xyz";
    if (components == 1) return "";
    if (components == 2 || components == 3) return std::string(1, kAxes[static_cast<std::size_t>(k)]);
    if (components == 9) return {kAxes[static_cast<std::size_t>(k / 3)], kAxes[static_cast<std::size_t>(k % 3)]};
    return std::to_string(k);
}

std::string component_name(const std::string& name, int components, int k) {
    return components == 1 ? name : name + "_" + component_suffix(components, k);
}

std::int64_t whole(double value) { return static_cast<std::int64_t>(value); }

}  // namespace lamella::io::detail
