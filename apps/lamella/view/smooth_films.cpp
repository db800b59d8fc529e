#include "view/smooth_films.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lamella::app::view {
namespace {

using Ends = FilmParts::Ends;

/// The inner control points of the cubic of an edge, seen from its first end.
using Inner = std::array<Vec3, 2>;

Inner reversed(const Inner& inner) { return {inner[1], inner[0]}; }

Inner straight(const Vec3& a, const Vec3& b) { return {a + (b - a) / 3.0, b - (b - a) / 3.0}; }

/// The cubic that is the parabola from a through m, at half of its parameter, to b.
Inner parabola(const Vec3& a, const Vec3& m, const Vec3& b) {
    const Vec3 control = 2.0 * m - 0.5 * (a + b);
    return {(a + 2.0 * control) / 3.0, (b + 2.0 * control) / 3.0};
}

Vec3 on_cubic(const Vec3& a, const Inner& inner, const Vec3& b, double s) {
    const double r = 1.0 - s;
    return r * r * r * a + 3.0 * r * r * s * inner[0] + 3.0 * r * s * s * inner[1] + s * s * s * b;
}

/// The frame's own quadratic triangles, or nothing.
const sim::Field* curved_nodes(const sim::Surface& surface) {
    constexpr std::size_t kNodeValues = 18;
    for (const sim::Field& field : surface.face_fields)
        if (field.name == sim::kCurvedNodes && field.components == static_cast<int>(kNodeValues) &&
            field.values.size() == kNodeValues * surface.triangles.size() &&
            std::ranges::all_of(field.values, [](double x) { return std::isfinite(x); }))
            return &field;
    return nullptr;
}

/// Ten control points of a cubic triangle; edge k runs from corner k to corner k + 1.
struct Patch {
    std::array<Vec3, 3> corner;
    std::array<Inner, 3> edge;
    Vec3 middle;

    /// @param weight  of the corners; they sum to 1
    Vec3 at(const std::array<double, 3>& weight) const {
        Vec3 x = 6.0 * weight[0] * weight[1] * weight[2] * middle;
        for (std::size_t k = 0; k < 3; ++k) {
            const double a = weight[k], b = weight[(k + 1) % 3];
            x += a * a * a * corner[k] + 3.0 * a * a * b * edge[k][0] + 3.0 * a * b * b * edge[k][1];
        }
        return x;
    }
};

class Smoother {
public:
    Smoother(const sim::Surface& surface, const FilmParts& parts)
        : surface_(surface), parts_(parts), nodes_(curved_nodes(surface)) {
        lines_.insert(lines_.end(), parts.borders.begin(), parts.borders.end());
        lines_.insert(lines_.end(), parts.wires.begin(), parts.wires.end());
        std::ranges::sort(lines_);
        if (nodes_ != nullptr)
            curve_lines_as_films();
        else
            curve_lines();
    }

    Patch patch(std::size_t face) const { return nodes_ != nullptr ? quadratic_patch(face) : patch_of_normals(face); }

    /// The cubic of a border or wire, seen from `ends[0]`; nullptr for any other edge.
    const Inner* line(const Ends& ends) const {
        const auto it = std::ranges::lower_bound(lines_, ends);
        return it != lines_.end() && *it == ends ? &curves_[static_cast<std::size_t>(it - lines_.begin())] : nullptr;
    }

    const Vec3& position(std::uint32_t vertex) const { return surface_.position[vertex]; }

private:
    Patch quadratic_patch(std::size_t face) const {
        std::array<Vec3, 6> node;
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t k = 0; k < 3; ++k) node[i][k] = nodes_->values[18 * face + 3 * i + k];
        Patch patch;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &a = node[k], &b = node[(k + 1) % 3], &m = node[3 + k];
            patch.corner[k] = a;
            patch.edge[k] = parabola(a, m, b);
            patch.middle += (2.0 * m - 0.5 * (a + b)) / 3.0;
        }
        return patch;
    }

    Patch patch_of_normals(std::size_t face) const {
        Patch patch;
        Vec3 edges, corners;
        for (std::size_t k = 0; k < 3; ++k) {
            patch.corner[k] = position(surface_.triangles[face][k]);
            patch.edge[k] = edge_of_normals(face, k);
            edges += (patch.edge[k][0] + patch.edge[k][1]) / 6.0;
            corners += patch.corner[k] / 3.0;
        }
        patch.middle = edges + 0.5 * (edges - corners);
        return patch;
    }

    Inner edge_of_normals(std::size_t face, std::size_t k) const {
        const std::size_t next = (k + 1) % 3;
        const std::uint32_t a = surface_.triangles[face][k], b = surface_.triangles[face][next];
        const std::uint32_t place_a = parts_.place[a], place_b = parts_.place[b];
        if (const Inner* curve = line({std::min(place_a, place_b), std::max(place_a, place_b)}))
            return place_a < place_b ? *curve : reversed(*curve);
        const Vec3 &x = position(a), &y = position(b);
        const Vec3& n = parts_.vertices[parts_.triangles[face][k]].normal;
        const Vec3& m = parts_.vertices[parts_.triangles[face][next]].normal;
        if (dot(n, m) < kFold) return straight(x, y);
        return {(2.0 * x + y - dot(y - x, n) * n) / 3.0, (2.0 * y + x - dot(x - y, m) * m) / 3.0};
    }

    void curve_lines_as_films() {
        curves_.resize(lines_.size());
        for (std::size_t face = 0; face < surface_.triangles.size(); ++face) {
            const Patch patch = quadratic_patch(face);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = parts_.place[surface_.triangles[face][k]];
                const std::uint32_t b = parts_.place[surface_.triangles[face][(k + 1) % 3]];
                const auto it = std::ranges::lower_bound(lines_, Ends{std::min(a, b), std::max(a, b)});
                if (it != lines_.end() && *it == Ends{std::min(a, b), std::max(a, b)})
                    curves_[static_cast<std::size_t>(it - lines_.begin())] =
                        a < b ? patch.edge[k] : reversed(patch.edge[k]);
            }
        }
    }

    void curve_lines() {
        std::vector<std::vector<std::uint32_t>> neighbors(surface_.position.size());
        for (const auto& [a, b] : lines_) {
            neighbors[a].push_back(b);
            neighbors[b].push_back(a);
        }
        /// Unit vector from `at` along the line to `to`, or nothing where it has no direction of its own.
        const auto tangent = [&](std::uint32_t at, std::uint32_t to) -> std::optional<Vec3> {
            if (neighbors[at].size() != 2) return std::nullopt;
            const std::uint32_t from = neighbors[at][0] == to ? neighbors[at][1] : neighbors[at][0];
            const Vec3 in = position(at) - position(from), out = position(to) - position(at);
            if (dot(in, out) < kCorner * norm(in) * norm(out)) return std::nullopt;
            const Vec3 sum = in / norm(in) + out / norm(out);
            return sum / norm(sum);
        };
        for (const auto& [a, b] : lines_) {
            const Vec3 chord = position(b) - position(a);
            const Vec3 unit = chord / norm(chord);
            const auto at_a = tangent(a, b), at_b = tangent(b, a);
            // An end without one bends as much as the other, which makes a parabola.
            const auto mirrored = [&](const Vec3& t) { return -1.0 * t + 2.0 * dot(t, unit) * unit; };
            const Vec3 from_a = at_a ? *at_a : at_b ? -1.0 * mirrored(*at_b) : unit;
            const Vec3 from_b = at_b ? *at_b : at_a ? -1.0 * mirrored(*at_a) : -1.0 * unit;
            curves_.push_back({position(a) + norm(chord) / 3.0 * from_a, position(b) + norm(chord) / 3.0 * from_b});
        }
    }

    static constexpr double kFold = 0.0;    // cosine between normals: a fold that no patch makes smooth
    static constexpr double kCorner = 0.7;  // cosine between edges: eight make a circle, four a square

    const sim::Surface& surface_;
    const FilmParts& parts_;
    const sim::Field* nodes_;
    std::vector<Ends> lines_;
    std::vector<Inner> curves_;  // one per line
};

void add_pieces(const FilmParts& parts,
                const sim::Surface& surface,
                const Patch& patch,
                std::uint32_t face,
                std::uint32_t pieces,
                SmoothFilms& result) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    const auto& corners = parts.triangles[face];
    for (std::uint32_t i = 0; i <= pieces; ++i)
        for (std::uint32_t j = 0; i + j <= pieces; ++j) {
            const double n = pieces;
            const std::array<double, 3> weights{(n - i - j) / n, j / n, i / n};
            Vec3 normal;
            for (std::size_t k = 0; k < 3; ++k) normal += weights[k] * parts.vertices[corners[k]].normal;
            const double length = norm(normal);
            if (!(length > 0.0)) normal = parts.vertices[corners[0]].normal;
            result.vertices.push_back({patch.at(weights), length > 0.0 ? normal / length : normal,
                                       parts.vertices[corners[0]].regions, surface.triangles[face], weights});
        }
    const auto number = [&](std::uint32_t i, std::uint32_t j) {  // row i has pieces + 1 - i vertices
        return first + i * (pieces + 1) - i * (i - 1) / 2 + j;   // i (i - 1) is 0 for i = 0 too, modulo 2^32
    };
    for (std::uint32_t i = 0; i < pieces; ++i)
        for (std::uint32_t j = 0; i + j < pieces; ++j) {
            result.triangles.push_back({number(i, j), number(i, j + 1), number(i + 1, j)});
            if (i + j + 1 < pieces)
                result.triangles.push_back({number(i, j + 1), number(i + 1, j + 1), number(i + 1, j)});
        }
    result.face.resize(result.triangles.size(), face);
}

SmoothFilms as_they_are(const sim::Surface& surface, const FilmParts& parts) {
    SmoothFilms result;
    for (const FilmParts::Vertex& v : parts.vertices)
        result.vertices.push_back(
            {surface.position[v.source], v.normal, v.regions, {v.source, v.source, v.source}, {1.0, 0.0, 0.0}});
    result.triangles = parts.triangles;
    for (std::uint32_t f = 0; f < parts.triangles.size(); ++f) result.face.push_back(f);
    for (const auto& [a, b] : parts.borders) result.borders.push_back({surface.position[a], surface.position[b]});
    for (const auto& [a, b] : parts.wires) result.wires.push_back({surface.position[a], surface.position[b]});
    return result;
}

}  // namespace

SmoothFilms smooth_films(const sim::Surface& surface, const FilmParts& parts, int pieces) {
    if (pieces <= 1) return as_they_are(surface, parts);
    const Smoother smoother(surface, parts);
    SmoothFilms result;
    for (std::uint32_t face = 0; face < surface.triangles.size(); ++face)
        add_pieces(parts, surface, smoother.patch(face), face, static_cast<std::uint32_t>(pieces), result);
    const auto add_line = [&](const Ends& ends, std::vector<SmoothFilms::Segment>& segments) {
        const Vec3 &a = surface.position[ends[0]], &b = surface.position[ends[1]];
        Vec3 before = a;
        for (int i = 1; i <= pieces; ++i) {
            const Vec3 x = on_cubic(a, *smoother.line(ends), b, static_cast<double>(i) / pieces);
            segments.push_back({before, x});
            before = x;
        }
    };
    for (const Ends& ends : parts.borders) add_line(ends, result.borders);
    for (const Ends& ends : parts.wires) add_line(ends, result.wires);
    return result;
}

}  // namespace lamella::app::view
