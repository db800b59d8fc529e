#include "lamella/io/detail/drawn_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace lamella::io::detail {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

struct Polyhedron {
    std::vector<Vec3> position;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

Polyhedron icosahedron() {
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    Polyhedron ball;
    for (const Vec3& p : {Vec3{{-1, g, 0}},
                          {{1, g, 0}},
                          {{-1, -g, 0}},
                          {{1, -g, 0}},
                          {{0, -1, g}},
                          {{0, 1, g}},
                          {{0, -1, -g}},
                          {{0, 1, -g}},
                          {{g, 0, -1}},
                          {{g, 0, 1}},
                          {{-g, 0, -1}},
                          {{-g, 0, 1}}})
        ball.position.push_back(p / norm(p));
    ball.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return ball;
}

/// Each triangle in four, with the new vertices on the sphere.
void cut(Polyhedron& ball) {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [it, fresh] =
            middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(ball.position.size()));
        if (fresh) {
            const Vec3 sum = ball.position[a] + ball.position[b];
            ball.position.push_back(sum / norm(sum));
        }
        return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : ball.triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const auto& t : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) finer.push_back(t);
    }
    ball.triangles = std::move(finer);
}

/// Of radius 1: 80 triangles after one cut, 1280 after three.
Polyhedron round_polyhedron(int cuts) {
    Polyhedron ball = icosahedron();
    for (int i = 0; i < cuts; ++i) cut(ball);
    return ball;
}

void add_ball(DrawnPart& part, const Polyhedron& ball, std::uint32_t source, const Vec3& center, double radius) {
    const auto first = static_cast<std::uint32_t>(part.position.size());
    for (const Vec3& p : ball.position) {
        part.source.push_back(source);
        part.position.push_back(center + radius * p);
        if (radius > 0.0) part.normal.push_back(p);
    }
    for (const auto& [a, b, c] : ball.triangles) part.triangles.push_back({a + first, b + first, c + first});
}

DrawnPart balls(const sim::Points& points) {
    DrawnPart part{.name = points.radius.empty() ? "points" : "bubbles", .fields = points.fields};
    const Polyhedron ball = points.radius.empty() ? Polyhedron{{Vec3{}}, {}} : round_polyhedron(1);
    for (std::uint32_t i = 0; i < points.size(); ++i)
        add_ball(part, ball, i, points.position[i], points.radius.empty() ? 0.0 : points.radius[i]);
    return part;
}

DrawnPart drawn_solids(const std::vector<sim::Solid>& solids) {
    DrawnPart part{.name = "solids"};
    const Polyhedron ball = round_polyhedron(3);
    for (std::uint32_t i = 0; i < solids.size(); ++i) add_ball(part, ball, i, solids[i].center, solids[i].radius);
    return part;
}

}  // namespace

std::vector<DrawnPart> drawn_parts(const sim::Frame& frame) {
    const sim::Surface& s = frame.surface;
    std::map<std::array<std::int32_t, 2>, std::vector<std::size_t>> films;
    for (std::size_t f = 0; f < s.triangles.size(); ++f) films[s.regions[f]].push_back(f);
    std::vector<DrawnPart> parts;
    std::vector<std::uint32_t> number(s.position.size(), kUnused);
    for (const auto& [regions, faces] : films) {
        DrawnPart part;
        part.name = fmt::format("film_{}_{}", regions[0], regions[1]);
        part.regions = regions;
        part.fields = s.vertex_fields;
        for (const std::size_t f : faces) {
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t v = s.triangles[f][k];
                if (number[v] == kUnused) {
                    number[v] = static_cast<std::uint32_t>(part.position.size());
                    part.source.push_back(v);
                    part.position.push_back(s.position[v]);
                }
                triangle[k] = number[v];
            }
            part.triangles.push_back(triangle);
        }
        for (const std::uint32_t v : part.source) number[v] = kUnused;
        parts.push_back(std::move(part));
    }
    if (!frame.points.empty()) parts.push_back(balls(frame.points));
    if (!frame.solids.empty()) parts.push_back(drawn_solids(frame.solids));
    return parts;
}

std::vector<double> part_values(const DrawnPart& part, const sim::Field& field) {
    const auto n = static_cast<std::size_t>(field.components);
    std::vector<double> values;
    values.reserve(n * part.source.size());
    for (const std::uint32_t v : part.source)
        for (std::size_t k = 0; k < n; ++k) values.push_back(field.values[n * v + k]);
    return values;
}

double linear_light(double encoded) {
    const double c = encoded / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

}  // namespace lamella::io::detail
