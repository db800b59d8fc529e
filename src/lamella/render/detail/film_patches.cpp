#include "lamella/render/detail/film_patches.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::render::detail {
namespace {

void check(const sim::Surface& surface) {
    for (std::size_t f = 0; f < surface.triangles.size(); ++f)
        for (const std::uint32_t v : surface.triangles[f])
            if (v >= surface.position.size())
                throw InputError(fmt::format("triangle {} refers to vertex {} of {}", f, v, surface.position.size()));
    for (std::size_t v = 0; v < surface.position.size(); ++v)
        for (const double x : surface.position[v].v)
            if (!std::isfinite(x)) throw InputError(fmt::format("vertex {} is not at a finite place", v));
}

/// The number of each value among the different ones, in their order.
template <class Key>
std::vector<std::uint32_t> numbered(const std::vector<Key>& keys, std::vector<Key>* different) {
    *different = keys;
    std::sort(different->begin(), different->end());
    different->erase(std::unique(different->begin(), different->end()), different->end());
    std::vector<std::uint32_t> number;
    number.reserve(keys.size());
    for (const Key& key : keys)
        number.push_back(static_cast<std::uint32_t>(std::lower_bound(different->begin(), different->end(), key) -
                                                    different->begin()));
    return number;
}

/// Vertices of films in a periodic box are their triangles' own: equal places (to rounding) are joined again.
std::vector<std::uint32_t> join_places(const sim::Surface& surface, FilmPatches* patches) {
    double extent = 0.0;
    for (const Vec3& p : surface.position) extent = std::max(extent, norm(p - surface.position[0]));
    const double grain = extent > 0.0 ? 1e-7 * extent : 1.0;
    std::vector<std::array<std::int64_t, 3>> cells, different;
    for (const Vec3& p : surface.position) {
        std::array<std::int64_t, 3> cell{};
        for (std::size_t k = 0; k < 3; ++k) cell[k] = std::llround((p[k] - surface.position[0][k]) / grain);
        cells.push_back(cell);
    }
    std::vector<std::uint32_t> place = numbered(cells, &different);
    patches->point.resize(different.size());
    for (std::size_t v = surface.position.size(); v-- > 0;) patches->point[place[v]] = surface.position[v];
    return place;
}

std::array<std::int32_t, 2> sides(const sim::Surface& surface, std::size_t f) {
    return f < surface.regions.size() ? surface.regions[f] : std::array<std::int32_t, 2>{0, 0};
}

void find_borders(const sim::Surface& surface, const std::vector<std::uint32_t>& place, FilmPatches* patches) {
    struct Use {
        std::array<std::uint32_t, 2> ends;
        std::uint32_t film;
        bool operator<(const Use& other) const { return ends != other.ends ? ends < other.ends : film < other.film; }
    };
    std::vector<Use> uses;
    for (std::size_t t = 0; t < patches->triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = patches->corner_point[patches->triangles[t][k]],
                                b = patches->corner_point[patches->triangles[t][(k + 1) % 3]];
            uses.push_back({{std::min(a, b), std::max(a, b)}, patches->film[t]});
        }
    std::sort(uses.begin(), uses.end());
    std::vector<std::uint8_t> held(patches->point.size(), 0);
    const sim::Field* on_wire = surface.find_of_vertices("on_wire");
    if (on_wire != nullptr && on_wire->values.size() == place.size())
        for (std::size_t v = 0; v < place.size(); ++v)
            if (on_wire->values[v] != 0.0) held[place[v]] = 1;
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t j = i;
        while (j < uses.size() && uses[j].ends == uses[i].ends) ++j;
        const bool smooth = j - i == 2 && uses[i].film == uses[i + 1].film;
        if (!smooth) {
            const bool wire =
                on_wire == nullptr ? j - i == 1 : held[uses[i].ends[0]] != 0 && held[uses[i].ends[1]] != 0;
            patches->borders.push_back({uses[i].ends, static_cast<int>(j - i), wire && j - i == 1});
        }
        i = j;
    }
}

/// Means of the triangles' normals, sum (a x b) / (|a|^2 |b|^2) over the edges a, b of a corner: exact inside a film
/// whose points lie on a sphere, as those of bubbles at rest do. [Max99]
void average_normals(FilmPatches* patches) {
    patches->corner_normal.assign(patches->corner_point.size(), Vec3{});
    for (const auto& t : patches->triangles) {
        std::array<Vec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = patches->point[patches->corner_point[t[k]]];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
            const double weight = squared_norm(a) * squared_norm(b);
            if (weight > 0.0) patches->corner_normal[t[k]] += cross(a, b) / weight;
        }
    }
    for (Vec3& n : patches->corner_normal) {
        const double length = norm(n);
        n = length > 0.0 ? n / length : Vec3{{0.0, 0.0, 1.0}};
    }
}

/// At a border a film has triangles on one side only, and the mean of their normals is that of a place further in. On a
/// sphere, and on any quadric, (n_a + n_b) . (x_a - x_b) = 0 along a chord: turns the normals of corners at borders
/// until this holds with their neighbors, whose own normals are good.
void correct_border_normals(FilmPatches* patches) {
    std::vector<std::uint8_t> at_border(patches->point.size(), 0);
    for (const BorderEdge& edge : patches->borders) at_border[edge.ends[0]] = at_border[edge.ends[1]] = 1;
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<Vec3> change(patches->corner_normal.size());
        std::vector<int> count(change.size(), 0);
        for (const auto& t : patches->triangles)
            for (std::size_t k = 0; k < 3; ++k)
                for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
                    const std::uint32_t a = t[k], b = t[other];
                    if (at_border[patches->corner_point[a]] == 0) continue;
                    const Vec3 chord =
                        patches->point[patches->corner_point[b]] - patches->point[patches->corner_point[a]];
                    const double square = squared_norm(chord);
                    if (square == 0.0) continue;
                    change[a] += -dot(patches->corner_normal[a] + patches->corner_normal[b], chord) / square * chord;
                    ++count[a];
                }
        for (std::size_t c = 0; c < change.size(); ++c) {
            if (count[c] == 0) continue;
            const Vec3 turned = patches->corner_normal[c] + change[c] / count[c];
            patches->corner_normal[c] = turned / norm(turned);
        }
    }
}

}  // namespace

FilmPatches film_patches(const sim::Surface& surface) {
    check(surface);
    FilmPatches patches;
    if (surface.triangles.empty()) return patches;
    const std::vector<std::uint32_t> place = join_places(surface, &patches);

    std::vector<std::array<std::int32_t, 2>> pairs, films;
    for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
        auto [back, front] = sides(surface, f);
        const auto& t = surface.triangles[f];
        if (place[t[0]] == place[t[1]] || place[t[1]] == place[t[2]] || place[t[2]] == place[t[0]]) continue;
        const bool turned = back > front;
        patches.source.push_back(static_cast<std::uint32_t>(f));
        patches.source_corner.push_back(turned ? std::array{t[0], t[2], t[1]} : t);
        pairs.push_back({std::min(back, front), std::max(back, front)});
    }
    patches.film = numbered(pairs, &films);

    std::vector<std::array<std::uint32_t, 2>> corners, different;  // film and place
    for (std::size_t t = 0; t < patches.source.size(); ++t)
        for (const std::uint32_t v : patches.source_corner[t]) corners.push_back({patches.film[t], place[v]});
    const std::vector<std::uint32_t> corner = numbered(corners, &different);
    for (const auto& [film, point] : different) patches.corner_point.push_back(point);
    for (std::size_t t = 0; t < patches.source.size(); ++t)
        patches.triangles.push_back({corner[3 * t], corner[3 * t + 1], corner[3 * t + 2]});
    find_borders(surface, place, &patches);
    average_normals(&patches);
    correct_border_normals(&patches);
    return patches;
}

}  // namespace lamella::render::detail
