#include "lamella/render/baked_frame.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/optics/film_color_table.h"
#include "lamella/render/camera.h"
#include "lamella/render/color_scale.h"
#include "lamella/render/detail/assumed_thickness.h"
#include "lamella/render/detail/frame_fields.h"
#include "lamella/render/detail/particle_average.h"

#include <fmt/format.h>

namespace lamella::render {
namespace {

using detail::FilmPatches;
using detail::NamedField;
using optics::Rgb;

/// One value per corner from those of the triangles' corners: their mean, where a face field makes them differ.
std::vector<double> joined_values(const FilmPatches& patches, const std::vector<std::array<double, 3>>& values) {
    std::vector<double> sum(patches.corner_point.size(), 0.0), count(sum.size(), 0.0);
    for (std::size_t t = 0; t < patches.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            sum[patches.triangles[t][k]] += values[t][k];
            count[patches.triangles[t][k]] += 1.0;
        }
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] /= count[c];
    return sum;
}

struct Thickness {
    std::vector<double> of_corner;  ///< [m]
    bool assumed = false;
};

Thickness thicknesses(const sim::Frame& frame, const FilmPatches& patches) {
    const auto field = detail::thickness_field(frame);
    if (field && field->place != NamedField::kPoints)
        return {joined_values(patches, detail::corner_values(patches, *field))};
    std::vector<double> values(patches.corner_point.size());
    if (const auto particles = detail::thickness_particles(frame)) {
        const detail::ParticleAverage average(*particles,
                                              detail::particle_spacing(frame.surface, particles->position.size()));
        for (std::size_t t = 0; t < patches.triangles.size(); ++t) {
            const auto regions = detail::regions_beside(frame.surface, patches.source[t]);
            for (const std::uint32_t c : patches.triangles[t])
                values[c] = average.at(patches.point[patches.corner_point[c]], regions).value_or(0.0);
        }
        return {values};
    }
    const Bounds bounds = frame_bounds(frame);
    const auto on_stage = [&](const Vec3& p) { return (p - bounds.center) / bounds.radius; };
    for (std::size_t t = 0; t < patches.triangles.size(); ++t)
        for (const std::uint32_t c : patches.triangles[t])
            values[c] = detail::assumed_thickness(on_stage(patches.point[patches.corner_point[c]]), patches.film[t]);
    return {values, true};
}

sim::Field color_field(std::size_t count) { return {"color", "-", 3, true, std::vector<double>(3 * count)}; }

void set_color(sim::Field& field, std::size_t item, const Rgb& color) {
    const auto shown = optics::display_color(color);
    for (std::size_t k = 0; k < 3; ++k) field.values[3 * item + k] = shown[k];
}

/// Colors by a field, or nothing where the films have none of that name.
std::optional<std::vector<Rgb>> field_colors(const sim::Frame& frame,
                                             const FilmPatches& patches,
                                             const std::string& name) {
    for (const NamedField& f : detail::find_fields(frame, name)) {
        if (f.place == NamedField::kPoints) continue;
        const ColorScale scale = scale_for(*f.field, scalar_values(*f.field));
        std::vector<Rgb> colors;
        for (const double value : joined_values(patches, detail::corner_values(patches, f)))
            colors.push_back(scale.color(value));
        return colors;
    }
    return std::nullopt;
}

sim::Surface baked_surface(const sim::Frame& frame, const std::string& field, bool* assumed) {
    const sim::Surface& from = frame.surface;
    const FilmPatches patches = detail::film_patches(from);
    const std::size_t corners = patches.corner_point.size();
    sim::Surface surface;
    surface.region_fields = from.region_fields;
    surface.triangles = patches.triangles;
    std::vector<std::uint32_t> source(corners);
    for (std::size_t t = 0; t < patches.triangles.size(); ++t) {
        const std::uint32_t f = patches.source[t];
        // Patches are turned so that their front is the region with the larger number.
        const std::array<std::int32_t, 2> sides = detail::regions_beside(from, f);
        surface.regions.push_back({std::min(sides[0], sides[1]), std::max(sides[0], sides[1])});
        for (std::size_t k = 0; k < 3; ++k) source[patches.triangles[t][k]] = patches.source_corner[t][k];
    }
    sim::Field normal{"normal", "-", 3, false, {}};
    for (std::size_t c = 0; c < corners; ++c) {
        surface.position.push_back(from.position[source[c]]);
        for (std::size_t k = 0; k < 3; ++k) normal.values.push_back(patches.corner_normal[c][k]);
    }
    const Thickness thickness = thicknesses(frame, patches);
    *assumed = thickness.assumed;
    sim::Field nanometers{"thickness_nm", "nm", 1, false, {}};
    for (const double h : thickness.of_corner) nanometers.values.push_back(1e9 * h);

    sim::Field color = color_field(corners);
    const auto by_field = field.empty() ? std::nullopt : field_colors(frame, patches, field);
    const optics::FilmColorTable table({}, {.thicknesses = 801, .cosines = 33});
    const double bright = 0.45 / optics::luminance(table.reflected(1.0, 1.0));
    for (std::size_t c = 0; c < corners; ++c)
        set_color(color, c, by_field ? (*by_field)[c] : bright * table.reflected(thickness.of_corner[c], 1.0));
    surface.vertex_fields = {normal, nanometers, color};

    for (const sim::Field& f : from.vertex_fields) {
        if (surface.find_of_vertices(f.name) != nullptr) continue;
        const auto n = static_cast<std::size_t>(f.components);
        sim::Field copy{f.name, f.unit, f.components, f.integer, {}};
        for (const std::uint32_t v : source)
            copy.values.insert(copy.values.end(), &f.values[n * v], &f.values[n * v] + n);
        surface.vertex_fields.push_back(std::move(copy));
    }
    for (const sim::Field& f : from.face_fields) {
        if (f.components > 3) continue;  // the nodes of curved triangles are not what they were for turned ones
        const auto n = static_cast<std::size_t>(f.components);
        sim::Field copy{f.name, f.unit, f.components, f.integer, {}};
        for (const std::uint32_t t : patches.source)
            copy.values.insert(copy.values.end(), &f.values[n * t], &f.values[n * t] + n);
        surface.face_fields.push_back(std::move(copy));
    }
    return surface;
}

void bake_points(const sim::Frame& frame, const std::string& name, sim::Points* points) {
    if (points->radius.empty() || points->find("color") != nullptr) return;
    sim::Field field = detail::radius_field(*points);
    if (!name.empty() && name != "radius")
        for (const NamedField& f : detail::find_fields(frame, name))
            if (f.place == NamedField::kPoints) field = *f.field;
    const std::vector<double> values = scalar_values(field);
    const ColorScale scale = scale_for(field, values);
    sim::Field color = color_field(points->size());
    for (std::size_t i = 0; i < points->size(); ++i) set_color(color, i, scale.color(values[i]));
    points->fields.push_back(std::move(color));
}

}  // namespace

sim::Frame baked_frame(const sim::Frame& frame, const std::string& field) {
    frame_bounds(frame);  // refuses a frame that shows nothing
    sim::Frame baked = frame;
    if (!field.empty() && field != "radius") detail::find_fields(frame, field);
    if (!frame.surface.triangles.empty()) {
        bool assumed = false;
        baked.surface = baked_surface(frame, field == "radius" ? "" : field, &assumed);
        baked.scalars.push_back({"thickness_assumed", "-", assumed ? 1.0 : 0.0, "1: drawn as drained films"});
    }
    bake_points(frame, field, &baked.points);
    return baked;
}

}  // namespace lamella::render
