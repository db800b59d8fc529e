#pragma once

#include "lamella/sim/frame.h"

#include <cmath>
#include <map>
#include <numbers>

namespace lamella::render {

/// A square film in the plane z = 0, 2 wide, cut into n x n squares; vertex field "thickness" where one is given.
inline sim::Frame flat_film(int n, std::optional<double> thickness = std::nullopt) {
    sim::Frame frame;
    sim::Surface& s = frame.surface;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) s.position.push_back({{2.0 * i / n - 1.0, 2.0 * j / n - 1.0, 0.0}});
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), b = a + 1,
                       c = a + static_cast<std::uint32_t>(n) + 1, d = c + 1;
            s.triangles.push_back({a, b, d});
            s.triangles.push_back({a, d, c});
        }
    s.regions.assign(s.triangles.size(), {0, 1});
    if (thickness)
        s.vertex_fields.push_back({"thickness", "m", 1, false, std::vector<double>(s.position.size(), *thickness)});
    return frame;
}

/// A sphere of radius 1: an octahedron whose triangles are cut in four `levels` times. Region 1 is inside.
inline sim::Frame sphere_film(int levels) {
    sim::Frame frame;
    sim::Surface& s = frame.surface;
    s.position = {{{1, 0, 0}}, {{-1, 0, 0}}, {{0, 1, 0}}, {{0, -1, 0}}, {{0, 0, 1}}, {{0, 0, -1}}};
    s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, fresh] =
                middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(s.position.size()));
            if (fresh) {
                const Vec3 sum = s.position[a] + s.position[b];
                s.position.push_back(sum / norm(sum));
            }
            return it->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : s.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            for (const std::array<std::uint32_t, 3>& t :
                 {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
                finer.push_back(t);
        }
        s.triangles = finer;
    }
    s.regions.assign(s.triangles.size(), {1, 0});
    return frame;
}

inline sim::Frame one_ball() {
    sim::Frame frame;
    frame.points.position = {{{0.0, 0.0, 0.0}}};
    frame.points.radius = {1.0};
    frame.points.fields.push_back({"pressure", "-", 1, false, {2.0}});
    return frame;
}

}  // namespace lamella::render
