#pragma once

#include "lamella/sim/frame.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace lamella {

/// Three half disks of radius 1 that meet in the z axis, 120 degrees apart, `n` by `n` triangles pairs each: regions 1,
/// 2 and 3 between them. The vertices on the axis are shared; each has its z as the field `height`.
inline sim::Frame three_sheets(std::uint32_t n = 4) {
    sim::Frame frame;
    frame.solver = "test";
    sim::Surface& surface = frame.surface;
    sim::Field height{"height", "m", 1, false, {}}, sheet_of{"sheet", "-", 1, true, {}};
    const auto add_vertex = [&](double r, double angle, double z) {
        surface.position.push_back({{r * std::cos(angle), r * std::sin(angle), z}});
        height.values.push_back(z);
        return static_cast<std::uint32_t>(surface.position.size() - 1);
    };
    std::vector<std::uint32_t> axis;
    for (std::uint32_t j = 0; j <= n; ++j) axis.push_back(add_vertex(0.0, 0.0, double(j) / n));
    for (int sheet = 0; sheet < 3; ++sheet) {
        std::vector<std::vector<std::uint32_t>> columns{axis};
        for (std::uint32_t i = 1; i <= n; ++i) {
            columns.emplace_back();
            for (std::uint32_t j = 0; j <= n; ++j)
                columns.back().push_back(
                    add_vertex(double(i) / n, sheet * 2.0 * std::numbers::pi / 3.0, double(j) / n));
        }
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; j < n; ++j) {
                const std::uint32_t a = columns[i][j], b = columns[i + 1][j], c = columns[i + 1][j + 1],
                                    d = columns[i][j + 1];
                surface.triangles.push_back({a, b, c});
                surface.triangles.push_back({a, d, c});  // turned the other way
                // The right normal of (a, b, c) points to the region that comes before in the angle.
                const std::int32_t after = sheet + 1, before = sheet == 0 ? 3 : sheet;
                surface.regions.push_back({after, before});
                surface.regions.push_back({before, after});
                sheet_of.values.insert(sheet_of.values.end(), 2, double(sheet));
            }
    }
    surface.vertex_fields.push_back(height);
    surface.face_fields.push_back(sheet_of);
    return frame;
}

/// Region 3 becomes the outside.
inline sim::Surface with_outside(sim::Surface surface) {
    for (auto& sides : surface.regions)
        for (std::int32_t& side : sides) side %= 3;
    return surface;
}

}  // namespace lamella
