#include "view/frame_message.h"

#include "lamella/core/error.h"
#include "lamella/measure/film_measures.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "view/decimate.h"
#include "view/film_parts.h"
#include "view/message.h"
#include "view/smooth_films.h"
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace lamella::app::view {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: what is not a number is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void append(std::vector<float>& out, const Vec3& x) {
    for (const double coordinate : x.v) out.push_back(static_cast<float>(coordinate));
}

/// Only what can be a color: a number, a vector's length, a tensor's. The corners of curved triangles are not.
bool can_be_shown(const sim::Field& field) {
    return field.components == 1 || field.components == 3 || field.components == 9;
}

void check_length(const sim::Field& field, std::size_t items) {
    if (field.values.size() != items * static_cast<std::size_t>(field.components))
        throw InputError(fmt::format("damaged frame: field {} has {} values for {} items of {}", field.name,
                                     field.values.size(), items, field.components));
}

/// `value(i, k)` is component k of the field at the i-th of `count` shown items.
template <class Value>
void add_field(Message& message, const std::string& set, const sim::Field& field, std::size_t count, Value&& value) {
    const auto components = static_cast<std::size_t>(field.components);
    std::vector<float> values;
    values.reserve(count * components);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < components; ++k) values.push_back(static_cast<float>(value(i, k)));
    message.add(set, field.name, field.unit, field.components, std::span<const float>(values));
}

/// Item `at(i)` of the field.
template <class Item>
auto item_of(const sim::Field& field, Item at) {
    return [&field, at](std::size_t i, std::size_t k) {
        return field.values[at(i) * static_cast<std::size_t>(field.components) + k];
    };
}

/// The vertex's value: of a field of whole numbers that of the nearest corner, and nothing is known between unknown
/// values.
double between(const sim::Field& field, const SmoothFilms::Vertex& vertex, std::size_t component) {
    const auto value = [&](std::size_t corner) {
        return field.values[vertex.sources[corner] * static_cast<std::size_t>(field.components) + component];
    };
    if (field.integer)
        return value(static_cast<std::size_t>(std::ranges::max_element(vertex.weights) - vertex.weights.begin()));
    double sum = 0.0;
    for (std::size_t corner = 0; corner < 3; ++corner)
        if (vertex.weights[corner] > 0.0) sum += vertex.weights[corner] * value(corner);
    return sum;
}

/// Eight bits would be steps of half a degree, in which a flat film mirrors a bent window.
std::int16_t normal_number(double x) {
    return static_cast<std::int16_t>(std::lround(32767.0 * std::clamp(x, -1.0, 1.0)));
}

void add_segments(Message& message,
                  const std::string& set,
                  const std::string& unit,
                  const std::vector<SmoothFilms::Segment>& segments) {
    std::vector<float> values;
    for (const auto& [a, b] : segments) {
        append(values, a);
        append(values, b);
    }
    message.add(set, "segment", unit, 6, std::span<const float>(values));
}

/// Into how many pieces an edge is cut so that there are at most `limit` triangles.
int pieces(std::size_t triangles, std::size_t limit) {
    constexpr int kMost = 4;
    for (int n = kMost; n > 1; --n)
        if (triangles * static_cast<std::size_t>(n * n) <= limit) return n;
    return 1;
}

void add_film_fields(Message& message, const sim::Surface& surface, const SmoothFilms& films) {
    for (const sim::Field& field : surface.vertex_fields) {
        check_length(field, surface.position.size());
        if (can_be_shown(field))
            add_field(message, "vertex_fields", field, films.vertices.size(),
                      [&](std::size_t i, std::size_t k) { return between(field, films.vertices[i], k); });
    }
    for (const sim::Field& field : surface.face_fields) {
        check_length(field, surface.triangles.size());
        if (can_be_shown(field))
            add_field(message, "face_fields", field, films.face.size(),
                      item_of(field, [&](std::size_t i) { return films.face[i]; }));
    }
}

void add_films(Message& message, const sim::Surface& surface, std::size_t smooth) {
    const SmoothFilms films = smooth_films(surface, film_parts(surface), pieces(surface.triangles.size(), smooth));
    std::vector<float> position;
    std::vector<std::int16_t> normal;
    std::vector<std::int32_t> regions;
    for (const SmoothFilms::Vertex& vertex : films.vertices) {
        append(position, vertex.position);
        for (const double x : vertex.normal.v) normal.push_back(normal_number(x));
        normal.push_back(0);
        regions.insert(regions.end(), vertex.regions.begin(), vertex.regions.end());
    }
    std::vector<std::uint32_t> corners;
    for (const auto& triangle : films.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
    message.add("vertices", "position", "m", 3, std::span<const float>(position));
    message.add("vertices", "normal", "-", 4, std::span<const std::int16_t>(normal));
    message.add("vertices", "regions", "-", 2, std::span<const std::int32_t>(regions));
    message.add("triangles", "corners", "-", 3, std::span<const std::uint32_t>(corners));
    add_segments(message, "borders", "m", films.borders);
    add_segments(message, "wires", "m", films.wires);
    add_film_fields(message, surface, films);
}

void add_points(Message& message, const sim::Points& points) {
    std::vector<float> position;
    for (const Vec3& x : points.position) append(position, x);
    message.add("points", "position", points.length_unit, 3, std::span<const float>(position));
    if (!points.radius.empty()) {
        const std::vector<float> radius(points.radius.begin(), points.radius.end());
        message.add("points", "radius", points.length_unit, 1, std::span<const float>(radius));
    }
    for (const sim::Field& field : points.fields) {
        check_length(field, points.size());
        if (can_be_shown(field))
            add_field(message, "point_fields", field, points.size(), item_of(field, [](std::size_t i) { return i; }));
    }
}

void add_solids(Message& message, const std::vector<sim::Solid>& solids) {
    std::vector<float> position, radius;
    for (const sim::Solid& solid : solids) {
        append(position, solid.center);
        radius.push_back(static_cast<float>(solid.radius));
    }
    message.add("solids", "position", "m", 3, std::span<const float>(position));
    message.add("solids", "radius", "m", 1, std::span<const float>(radius));
}

Json box_json(const sim::Box& box) {
    return {{"dimension", box.dimension},
            {"origin", {box.origin[0], box.origin[1], box.origin[2]}},
            {"lengths", {box.lengths[0], box.lengths[1], box.lengths[2]}},
            {"periodic", box.periodic}};
}

}  // namespace

std::string frame_message(const sim::Frame& frame, const DetailLimits& limits) {
    const sim::Surface surface = thinned(frame.surface, limits.triangles);
    const sim::Points points = thinned(frame.points, limits.points);
    Message message;
    if (!surface.empty()) add_films(message, surface, limits.smooth);
    if (!points.empty()) add_points(message, points);
    if (!frame.solids.empty()) add_solids(message, frame.solids);

    Json scalars = Json::array();
    for (const sim::Scalar& scalar : frame.scalars)
        scalars.push_back(
            {{"name", scalar.name}, {"unit", scalar.unit}, {"value", number(scalar.value)}, {"text", scalar.text}});
    return message.finish(
        {{"solver", frame.solver},
         {"time", frame.time},
         {"time_unit", frame.time_unit},
         {"step", frame.step},
         {"box", frame.box ? box_json(*frame.box) : Json(nullptr)},
         {"triangles", {{"shown", surface.triangles.size()}, {"all", frame.surface.triangles.size()}}},
         {"points", {{"shown", points.size()}, {"all", frame.points.size()}}},
         {"scalars", scalars}});
}

std::string regions_text(const sim::Frame& frame) {
    Json regions = Json::array();
    if (const auto films = measure::film_measures(frame)) {
        for (const measure::RegionMeasure& region : films->regions) {
            Json neighbors = Json::array();
            for (const measure::FilmMeasure& film : films->films)
                if (film.a == region.id || film.b == region.id)
                    neighbors.push_back({{"id", film.a == region.id ? film.b : film.a}, {"area", number(film.area)}});
            regions.push_back({{"id", region.id},
                               {"volume", number(region.volume)},
                               {"pressure", number(region.pressure)},
                               {"area", number(region.area)},
                               {"neighbors", neighbors}});
        }
    }
    return Json{{"regions", regions}}.dump();
}

}  // namespace lamella::app::view
