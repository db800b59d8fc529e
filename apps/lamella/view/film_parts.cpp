#include "view/film_parts.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace lamella::app::view {
namespace {

void check(const sim::Surface& surface) {
    if (surface.regions.size() != surface.triangles.size())
        throw InputError(fmt::format("damaged frame: {} pairs of regions for {} triangles", surface.regions.size(),
                                     surface.triangles.size()));
    for (std::size_t f = 0; f < surface.triangles.size(); ++f)
        for (const std::uint32_t v : surface.triangles[f])
            if (v >= surface.position.size())
                throw InputError(
                    fmt::format("damaged frame: triangle {} refers to vertex {} of {}", f, v, surface.position.size()));
}

/// For each vertex the first one at the same place.
std::vector<std::uint32_t> places(const std::vector<Vec3>& position) {
    std::vector<std::uint32_t> order(position.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t v) { return std::tuple(position[v][0], position[v][1], position[v][2]); };
    std::ranges::sort(order,
                      [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    std::vector<std::uint32_t> place(position.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        place[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? place[order[i - 1]] : order[i];
    return place;
}

std::array<std::int32_t, 2> film_of(const std::array<std::int32_t, 2>& sides) {
    return {std::min(sides[0], sides[1]), std::max(sides[0], sides[1])};
}

/// A corner of a triangle: equal place and film, same vertex of the result.
struct Corner {
    std::uint32_t place;
    std::array<std::int32_t, 2> film;
    std::uint32_t triangle;
    std::uint32_t at;

    bool same_vertex(const Corner& other) const { return place == other.place && film == other.film; }
    bool operator<(const Corner& other) const {
        return std::tie(place, film, triangle, at) < std::tie(other.place, other.film, other.triangle, other.at);
    }
};

/// What a triangle adds to the normal at its corner `at`, pointing into the larger region of its film. With these
/// weights the normal of a vertex is exact where it and its neighbors lie on a sphere, as bubbles do nearly [Max99].
Vec3 normal_part(const sim::Surface& surface, std::size_t f, std::size_t at) {
    const auto& triangle = surface.triangles[f];
    const Vec3& x = surface.position[triangle[at]];
    const Vec3 e1 = surface.position[triangle[(at + 1) % 3]] - x, e2 = surface.position[triangle[(at + 2) % 3]] - x;
    const double scale = squared_norm(e1) * squared_norm(e2);
    if (!(scale > 0.0)) return {};
    return (surface.regions[f][0] <= surface.regions[f][1] ? 1.0 : -1.0) / scale * cross(e1, e2);
}

void split_vertices(const sim::Surface& surface, FilmParts& parts) {
    std::vector<Corner> corners;
    corners.reserve(3 * surface.triangles.size());
    for (std::uint32_t f = 0; f < surface.triangles.size(); ++f)
        for (std::uint32_t k = 0; k < 3; ++k)
            corners.push_back({parts.place[surface.triangles[f][k]], film_of(surface.regions[f]), f, k});
    std::ranges::sort(corners, std::less<>{});

    parts.triangles.resize(surface.triangles.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Corner& corner = corners[i];
        if (i == 0 || !corner.same_vertex(corners[i - 1]))
            parts.vertices.push_back({surface.triangles[corner.triangle][corner.at], corner.film, {}});
        parts.vertices.back().normal += normal_part(surface, corner.triangle, corner.at);
        parts.triangles[corner.triangle][corner.at] = static_cast<std::uint32_t>(parts.vertices.size() - 1);
    }
    for (FilmParts::Vertex& vertex : parts.vertices) {
        const double length = norm(vertex.normal);
        vertex.normal = length > 0.0 ? (1.0 / length) * vertex.normal : Vec3{0.0, 0.0, 1.0};
    }
}

void find_lines(const sim::Surface& surface, FilmParts& parts) {
    const sim::Field* on_wire = surface.find_of_vertices("on_wire");
    const auto wired = [&](std::uint32_t v) {
        return on_wire != nullptr && on_wire->components == 1 && v < on_wire->values.size() &&
               on_wire->values[v] != 0.0;
    };
    // Where nothing is said about wires a film ends on one, but for a foam without an outside: it is cut at its periods.
    const bool rims_are_wires = on_wire == nullptr && std::ranges::any_of(surface.regions, [](const auto& sides) {
        return sides[0] <= 0 || sides[1] <= 0;
    });
    std::vector<FilmParts::Ends> edges;
    edges.reserve(3 * surface.triangles.size());
    for (const auto& triangle : surface.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = parts.place[triangle[k]], b = parts.place[triangle[(k + 1) % 3]];
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
        }
    std::ranges::sort(edges);
    for (std::size_t begin = 0; begin < edges.size();) {
        std::size_t end = begin;
        while (end < edges.size() && edges[end] == edges[begin]) ++end;
        const auto& [a, b] = edges[begin];
        const std::size_t films = end - begin;
        if ((films == 1 && rims_are_wires) || (films != 2 && wired(a) && wired(b)))
            parts.wires.push_back(edges[begin]);
        else if (films != 2)
            parts.borders.push_back(edges[begin]);
        begin = end;
    }
}

}  // namespace

FilmParts film_parts(const sim::Surface& surface) {
    check(surface);
    FilmParts parts;
    parts.place = places(surface.position);
    split_vertices(surface, parts);
    find_lines(surface, parts);
    return parts;
}

}  // namespace lamella::app::view
