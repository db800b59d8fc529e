#include "lamella/render/detail/frame_fields.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/render/color_scale.h"

#include <fmt/format.h>

namespace lamella::render::detail {

namespace {

std::vector<NamedField> shown_fields(const sim::Frame& frame) {
    std::vector<NamedField> fields;
    if (!frame.surface.triangles.empty()) {
        for (const sim::Field& f : frame.surface.vertex_fields) fields.push_back({&f, NamedField::kVertices});
        for (const sim::Field& f : frame.surface.face_fields)
            if (f.components <= 3) fields.push_back({&f, NamedField::kFaces});
    }
    for (const sim::Field& f : frame.points.fields) fields.push_back({&f, NamedField::kPoints});
    return fields;
}

}  // namespace

std::vector<NamedField> find_fields(const sim::Frame& frame, const std::string& name) {
    std::vector<NamedField> found;
    std::vector<std::string> names;
    for (const NamedField& f : shown_fields(frame)) {
        names.push_back(f.field->name);
        if (f.field->name == name) found.push_back(f);
    }
    if (!found.empty()) return found;
    const auto near = nearest_word(name, names);
    std::string list;
    for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
    throw InputError(fmt::format("the frame has no field {}{}; it has {}", name,
                                 near ? fmt::format("; did you mean {}?", *near) : "", list.empty() ? "none" : list));
}

std::array<std::int32_t, 2> regions_beside(const sim::Surface& surface, std::size_t triangle) {
    return triangle < surface.regions.size() ? surface.regions[triangle] : std::array<std::int32_t, 2>{};
}

sim::Field radius_field(const sim::Points& points) { return {"radius", points.length_unit, 1, false, points.radius}; }

std::vector<std::array<double, 3>> corner_values(const FilmPatches& patches, const NamedField& field) {
    const std::vector<double> values = scalar_values(*field.field);
    std::vector<std::array<double, 3>> corners(patches.triangles.size());
    for (std::size_t t = 0; t < corners.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i =
                field.place == NamedField::kVertices ? patches.source_corner[t][k] : patches.source[t];
            if (i >= values.size()) throw InputError(fmt::format("field {} has too few values", field.field->name));
            corners[t][k] = values[i];
        }
    return corners;
}

std::optional<NamedField> thickness_field(const sim::Frame& frame) {
    for (const NamedField& f : shown_fields(frame))
        if (f.field->name == "thickness" && f.field->components == 1) return f;
    return std::nullopt;
}

}  // namespace lamella::render::detail
