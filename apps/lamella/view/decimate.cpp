#include "view/decimate.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace lamella::app::view {
namespace {

/// Keeps the items of a field that `kept` names.
sim::Field selected(const sim::Field& field, std::size_t items, const std::vector<std::uint32_t>& kept) {
    const auto components = static_cast<std::size_t>(field.components);
    if (field.values.size() != items * components)
        throw InputError(fmt::format("damaged frame: field {} has {} values for {} items of {}", field.name,
                                     field.values.size(), items, components));
    sim::Field result{field.name, field.unit, field.components, field.integer, {}};
    result.values.reserve(kept.size() * components);
    for (const std::uint32_t i : kept)
        for (std::size_t k = 0; k < components; ++k) result.values.push_back(field.values[i * components + k]);
    return result;
}

std::vector<sim::Field> selected(const std::vector<sim::Field>& fields, std::size_t items,
                                 const std::vector<std::uint32_t>& kept) {
    std::vector<sim::Field> result;
    for (const sim::Field& field : fields) result.push_back(selected(field, items, kept));
    return result;
}

using Cell = std::array<std::int64_t, 3>;

Cell cell_of(const Vec3& x, double size) {
    return {std::llround(std::floor(x[0] / size)), std::llround(std::floor(x[1] / size)),
            std::llround(std::floor(x[2] / size))};
}

/// For every vertex the one that stands for its cell.
std::vector<std::uint32_t> representatives(const std::vector<Vec3>& position, double size) {
    std::vector<std::pair<Cell, std::uint32_t>> order;
    order.reserve(position.size());
    for (std::uint32_t v = 0; v < position.size(); ++v) order.emplace_back(cell_of(position[v], size), v);
    std::ranges::sort(order);
    std::vector<std::uint32_t> result(position.size());
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin;
        Vec3 sum;
        for (; end < order.size() && order[end].first == order[begin].first; ++end) sum += position[order[end].second];
        const Vec3 mean = (1.0 / static_cast<double>(end - begin)) * sum;
        std::uint32_t nearest = order[begin].second;
        for (std::size_t i = begin; i < end; ++i)
            if (squared_norm(position[order[i].second] - mean) < squared_norm(position[nearest] - mean))
                nearest = order[i].second;
        for (std::size_t i = begin; i < end; ++i) result[order[i].second] = nearest;
        begin = end;
    }
    return result;
}

/// The triangles that keep three different corners, each set of corners once per film.
std::vector<std::uint32_t> surviving(const sim::Surface& surface, const std::vector<std::uint32_t>& stands_for) {
    using Key = std::array<std::int64_t, 5>;
    std::vector<std::pair<Key, std::uint32_t>> keys;
    for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
        std::array<std::int64_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) corners[k] = stands_for[surface.triangles[f][k]];
        std::ranges::sort(corners);
        if (corners[0] == corners[1] || corners[1] == corners[2]) continue;
        const auto& [back, front] = surface.regions[f];
        keys.push_back({{corners[0], corners[1], corners[2], std::min(back, front), std::max(back, front)}, f});
    }
    std::ranges::sort(keys);
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (i == 0 || keys[i].first != keys[i - 1].first) kept.push_back(keys[i].second);
    std::ranges::sort(kept);
    return kept;
}

sim::Surface clustered(const sim::Surface& surface, double size) {
    const std::vector<std::uint32_t> stands_for = representatives(surface.position, size);
    const std::vector<std::uint32_t> faces = surviving(surface, stands_for);
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> new_number(surface.position.size(), kUnused);
    std::vector<std::uint32_t> vertices;

    sim::Surface result;
    for (const std::uint32_t f : faces) {
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = stands_for[surface.triangles[f][k]];
            if (new_number[v] == kUnused) {
                new_number[v] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(v);
                result.position.push_back(surface.position[v]);
            }
            corners[k] = new_number[v];
        }
        result.triangles.push_back(corners);
        result.regions.push_back(surface.regions[f]);
    }
    result.vertex_fields = selected(surface.vertex_fields, surface.position.size(), vertices);
    result.face_fields = selected(surface.face_fields, surface.triangles.size(), faces);
    result.region_fields = surface.region_fields;
    return result;
}

double total_area(const sim::Surface& surface) {
    double area = 0.0;
    for (const auto& [a, b, c] : surface.triangles)
        area += 0.5 * norm(cross(surface.position[b] - surface.position[a], surface.position[c] - surface.position[a]));
    return area;
}

void check(const sim::Surface& surface) {
    if (surface.regions.size() != surface.triangles.size())
        throw InputError("damaged frame: triangles and their regions do not fit together");
    for (const auto& triangle : surface.triangles)
        for (const std::uint32_t v : triangle)
            if (v >= surface.position.size()) throw InputError("damaged frame: a triangle refers to a missing vertex");
    for (const Vec3& x : surface.position)
        for (const double coordinate : x.v)
            if (!std::isfinite(coordinate)) throw InputError("damaged frame: a vertex is not at a finite place");
}

}  // namespace

sim::Surface thinned(const sim::Surface& surface, std::size_t limit) {
    if (surface.triangles.size() <= limit || limit == 0) return surface;
    check(surface);
    const double area = total_area(surface);
    if (!(area > 0.0)) throw InputError("damaged frame: its films have no area");
    // A plane film has about two triangles per cell; curved and slanted ones have more, so the cells may have to grow.
    double size = std::sqrt(2.0 * area / static_cast<double>(limit));
    constexpr double kGrowth = 1.15;
    sim::Surface result = clustered(surface, size);
    while (result.triangles.size() > limit) result = clustered(surface, size *= kGrowth);
    return result;
}

sim::Points thinned(const sim::Points& points, std::size_t limit) {
    if (points.size() <= limit || limit == 0) return points;
    const std::size_t stride = (points.size() + limit - 1) / limit;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < points.size(); i += stride) kept.push_back(static_cast<std::uint32_t>(i));
    sim::Points result;
    result.length_unit = points.length_unit;
    for (const std::uint32_t i : kept) {
        result.position.push_back(points.position[i]);
        if (!points.radius.empty()) result.radius.push_back(points.radius[i]);
    }
    result.fields = selected(points.fields, points.size(), kept);
    return result;
}

}  // namespace lamella::app::view
