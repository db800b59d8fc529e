#include "lamella/render/detail/stage.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/render/detail/assumed_thickness.h"
#include "lamella/render/detail/frame_fields.h"
#include "lamella/render/detail/particle_average.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lamella::render {

namespace {

using detail::corner_values;
using detail::FilmPatches;
using detail::find_fields;
using detail::NamedField;
using detail::radius_field;
using detail::Stage;
using detail::thickness_field;

/// As many pieces per edge as make a few hundred thousand triangles, or enough to show every particle of the films.
int pieces_for(std::size_t triangles, std::size_t particles) {
    constexpr std::size_t kWanted = 240'000, kMost = 2'000'000;
    const int finest = particles > 0 ? 24 : 12;
    const std::size_t wanted = std::clamp(4 * particles, kWanted, kMost);
    int pieces = 1;
    while (pieces < finest && triangles * static_cast<std::size_t>((pieces + 1) * (pieces + 1)) <= wanted) ++pieces;
    return pieces;
}

void scale_into_ball(FilmPatches& patches, const Bounds& bounds) {
    for (Vec3& p : patches.point) p = (p - bounds.center) / bounds.radius;
}

double mean_edge(const FilmPatches& patches) {
    double sum = 0.0;
    for (const auto& t : patches.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            sum +=
                norm(patches.point[patches.corner_point[t[k]]] - patches.point[patches.corner_point[t[(k + 1) % 3]]]);
    return sum / (3.0 * static_cast<double>(patches.triangles.size()));
}

void add_threads(const FilmPatches& patches, int pieces, double width, detail::RayGeometry* geometry) {
    if (width == 0.0) return;
    // Wires are as thick as a thin rod; borders as threads that do not hide the films, thinner where bubbles are small.
    const double wire = 0.011 * width;
    const double border = std::min(0.0055, 0.16 * mean_edge(patches)) * width;
    for (const detail::Thread& thread : refine_borders(patches, std::max(2, pieces))) {
        const double radius = thread.wire ? wire : border;
        for (std::size_t i = 0; i < thread.points.size(); ++i) {
            const Vec3& p = thread.points[i];
            if (i + 1 < thread.points.size()) {
                geometry->thread_segments.push_back(static_cast<std::uint32_t>(geometry->thread_points.size()));
                geometry->segment_is_wire.push_back(thread.wire ? 1 : 0);
            }
            geometry->thread_points.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]),
                                               static_cast<float>(p[2]), static_cast<float>(radius)});
        }
    }
}

/// Points without a radius lie about so far apart as the square root of their share of the ball's surface.
double point_radius(const sim::Points& points) {
    return 0.5 * std::sqrt(4.0 * 3.1415926535897932 / static_cast<double>(points.size()));
}

void add_balls(const sim::Frame& frame, const PictureOptions& options, Stage* stage, detail::RayGeometry* geometry) {
    const sim::Points& points = frame.points;
    if (points.empty()) return;
    const bool balls = points.radius.size() == points.size();
    const std::optional<NamedField> thickness = thickness_field(frame);
    if (!balls && !frame.surface.triangles.empty()) return;  // particles of the films: seen as their thickness

    const bool by_thickness = options.field.empty() && !balls && thickness;
    sim::Field field = radius_field(points);
    if (!options.field.empty() && options.field != "radius") {
        const auto found = find_fields(frame, options.field);
        const auto it = std::find_if(found.begin(), found.end(),
                                     [](const NamedField& f) { return f.place == NamedField::kPoints; });
        if (it == found.end())
            throw InputError(fmt::format("field {} belongs to the films, not to the points", options.field));
        field = *it->field;
    }
    const std::vector<double> values = by_thickness ? thickness->field->values : scalar_values(field);
    if (!values.empty() && values.size() != points.size())
        throw InputError(fmt::format("field {} has {} values for {} points", field.name, values.size(), points.size()));
    const ColorScale scale = options.scale ? *options.scale : scale_for(field, values);
    if (!options.field.empty()) stage->scale = scale;
    const optics::FilmColors colors;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 p = (points.position[i] - stage->bounds.center) / stage->bounds.radius;
        const double radius = balls ? points.radius[i] / stage->bounds.radius : point_radius(points);
        geometry->balls.push_back(
            {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]), static_cast<float>(radius)});
        constexpr double kThickFilm = 0.04;  // reflectance that shows as half of white
        stage->ball_color.push_back(values.empty() ? optics::Rgb{{0.6, 0.6, 0.6}}
                                    : by_thickness
                                        ? optics::desaturate(0.5 / kThickFilm * colors.reflected(values[i], 1.0))
                                        : scale.color(values[i]));
    }
}

/// Dark and glossy, so that they are told from bubbles and hide no colors.
void add_solids(const std::vector<sim::Solid>& solids, Stage* stage, detail::RayGeometry* geometry) {
    constexpr optics::Rgb kGraphite{{0.10, 0.10, 0.11}};
    for (const sim::Solid& solid : solids) {
        const Vec3 p = (solid.center - stage->bounds.center) / stage->bounds.radius;
        geometry->balls.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
                                   static_cast<float>(solid.radius / stage->bounds.radius)});
        stage->ball_color.push_back(kGraphite);
    }
}

/// What each corner of the films shows: the field, or the thickness [m].
std::vector<std::array<double, 3>> film_values(const sim::Frame& frame,
                                               const FilmPatches& patches,
                                               const PictureOptions& options,
                                               Stage* stage) {
    if (!options.field.empty()) {
        for (const NamedField& f : find_fields(frame, options.field)) {
            if (f.place == NamedField::kPoints) continue;
            stage->films_show_field = true;
            stage->scale = options.scale ? *options.scale : scale_for(*f.field, scalar_values(*f.field));
            return corner_values(patches, f);
        }
    }
    if (options.thickness <= 0.0)
        if (const auto field = thickness_field(frame); field && field->place != NamedField::kPoints)
            return corner_values(patches, *field);
    return {patches.triangles.size(), {options.thickness, options.thickness, options.thickness}};
}

/// Of any point of the fine films, the patch it is part of.
std::size_t patch_of(const Stage& stage, const FilmPatches& patches, std::size_t point) {
    return point / (stage.films.position.size() / patches.triangles.size());
}

/// What particles carry, at their own resolution; where there are none nearby, films show what their corners say.
void take_from_particles(const sim::Surface& surface,
                         const FilmPatches& patches,
                         const detail::FilmParticles& particles,
                         Stage* stage) {
    const detail::ParticleAverage average(particles, detail::particle_spacing(surface, particles.position.size()));
    parallel_for(stage->films.position.size(), [&](std::size_t i) {
        const auto& p = stage->films.position[i];
        Vec3 place = stage->bounds.center;
        for (std::size_t k = 0; k < 3; ++k) place[k] += stage->bounds.radius * static_cast<double>(p[k]);
        const std::uint32_t triangle = patches.source[patch_of(*stage, patches, i)];
        const auto value = average.at(place, detail::regions_beside(surface, triangle));
        if (value) stage->films.value[i] = static_cast<float>(*value);
    });
}

/// Thicknesses that vary within a triangle: from particles, or assumed.
void refine_thickness(const sim::Frame& frame,
                      const FilmPatches& patches,
                      const PictureOptions& options,
                      Stage* stage) {
    if (stage->films_show_field) return;
    stage->thickness_origin = "given";
    if (options.thickness > 0.0) return;
    if (const auto particles = detail::thickness_particles(frame)) {
        stage->thickness_origin = "particles";
        return take_from_particles(frame.surface, patches, *particles, stage);
    }
    stage->thickness_origin = "frame";
    if (thickness_field(frame)) return;
    stage->thickness_origin = "assumed: films that have drained for a while, 0.2 um above to 0.8 um below";
    parallel_for(stage->films.position.size(), [&](std::size_t i) {
        const auto& p = stage->films.position[i];
        const Vec3 place{{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}};
        stage->films.value[i] =
            static_cast<float>(detail::assumed_thickness(place, patches.film[patch_of(*stage, patches, i)]));
    });
}

double lowest_point(const detail::RayGeometry& geometry) {
    float lowest = 1.0F;
    for (const auto& p : geometry.film_position) lowest = std::min(lowest, p[2]);
    for (const auto& p : geometry.thread_points) lowest = std::min(lowest, p[2] - p[3]);
    for (const auto& p : geometry.balls) lowest = std::min(lowest, p[2] - p[3]);
    return static_cast<double>(lowest);
}

}  // namespace

ColorScale field_scale(const sim::Frame& frame, const std::string& name) {
    if (name == "radius" && !frame.points.radius.empty()) {
        const sim::Field field = radius_field(frame.points);
        return scale_for(field, field.values);
    }
    const sim::Field& field = *find_fields(frame, name).front().field;
    return scale_for(field, scalar_values(field));
}

detail::Stage detail::make_stage(const sim::Frame& frame, const PictureOptions& options) {
    Stage stage;
    stage.bounds = options.bounds ? *options.bounds : frame_bounds(frame);
    RayGeometry geometry;
    if (!frame.surface.triangles.empty()) {
        FilmPatches patches = film_patches(frame.surface);
        scale_into_ball(patches, stage.bounds);
        const auto particles = thickness_particles(frame);
        const int pieces = pieces_for(patches.triangles.size(), particles ? particles->position.size() : 0);
        stage.films = refine_films(patches, film_values(frame, patches, options, &stage), pieces);
        refine_thickness(frame, patches, options, &stage);
        geometry.film_position = stage.films.position;
        geometry.film_triangles = stage.films.triangles;
        add_threads(patches, pieces, options.border_width, &geometry);
    }
    add_balls(frame, options, &stage, &geometry);
    add_solids(frame.solids, &stage, &geometry);
    if (options.ground) stage.ground = Ground{lowest_point(geometry) - 0.004, {}};
    if (!options.field.empty() && !stage.scale) field_scale(frame, options.field);  // says what fields there are
    stage.rays = std::make_unique<RayScene>(std::move(geometry));
    return stage;
}

}  // namespace lamella::render
