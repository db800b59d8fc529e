#pragma once

#include "lamella/sim/frame.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace lamella::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Every kind of value a field can hold: ordinary, tiny, negative zero, not finite.
inline double awkward_value(std::size_t i) {
    const double special[] = {0.0, -0.0, kNan, kInfinity, -kInfinity, 5e-324, 1.7976931348623157e308, 0.1};
    return i % 3 == 0 ? special[i / 3 % 8]
                      : std::sin(static_cast<double>(i)) * std::pow(10.0, static_cast<double>(i % 40) - 20.0);
}

inline sim::Field awkward_field(const std::string& name, const std::string& unit, int components, std::size_t count) {
    sim::Field field{name, unit, components, false, {}};
    for (std::size_t i = 0; i < count * static_cast<std::size_t>(components); ++i) {
        field.values.push_back(awkward_value(i + name.size()));
    }
    return field;
}

inline sim::Field whole_field(const std::string& name, std::size_t count) {
    sim::Field field{name, "-", 1, true, {}};
    for (std::size_t i = 0; i < count; ++i) {
        field.values.push_back(i == 0 ? 9007199254740992.0 : i == 1 ? -9007199254740992.0 : static_cast<double>(i));
    }
    return field;
}

inline void add_points(sim::Frame& frame, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = static_cast<double>(i);
        frame.points.position.push_back({{std::sqrt(x), -x / 3.0, awkward_value(i)}});
        frame.points.radius.push_back(0.5 + 1.0 / (1.0 + x));
    }
    frame.points.fields = {awkward_field("velocity", "m/s", 3, count), awkward_field("pressure", "Pa", 1, count),
                           whole_field("id", count), awkward_field("stress", "Pa", 9, count)};
}

/// A fan of triangles around vertex 0.
inline void add_surface(sim::Frame& frame, std::uint32_t triangles) {
    sim::Surface& surface = frame.surface;
    for (std::uint32_t i = 0; i < triangles + 2; ++i) {
        surface.position.push_back({{std::cos(i), std::sin(i), 0.25 * i}});
    }
    for (std::uint32_t i = 0; i < triangles; ++i) {
        surface.triangles.push_back({0, i + 1, i + 2});
        surface.regions.push_back({static_cast<std::int32_t>(i % 3), 4});
    }
    surface.vertex_fields = {awkward_field("thickness", "m", 1, triangles + 2),
                             awkward_field("velocity", "m/s", 3, triangles + 2)};
    surface.face_fields = {awkward_field("tension", "N/m", 1, triangles), whole_field("film", triangles),
                           awkward_field("force", "N", 3, triangles)};
    surface.region_fields = {awkward_field("pressure", "Pa", 1, 6), whole_field("closed", 6),
                             awkward_field("centroid", "m", 3, 6)};
    frame.solids = {{{{0.1, -0.0, 5e-324}}, 0.25}, {{{-1e300, 2.0, 1.0 / 3.0}}, 1e-300}};
}

inline sim::Frame described_frame() {
    sim::Frame frame;
    frame.solver = "bubble";
    frame.time = 0.1;
    frame.step = 123456789012345;
    frame.box = sim::Box{
        .dimension = 2, .origin = {{-1.0, 0.5, 0.0}}, .lengths = {{3.0, 4.0, 0.0}}, .periodic = {true, false, false}};
    frame.scalars = {{"energy", "J", 1.0 / 3.0, "kinetic & <potential> \"energy\" µ"},
                     {"gas_fraction", "-", kNan, ""},
                     {"pressure_1-2", "Pa", -0.0, "of region 1 against 2"}};
    return frame;
}

inline sim::Frame points_frame(std::size_t count) {
    sim::Frame frame = described_frame();
    add_points(frame, count);
    return frame;
}
inline sim::Frame surface_frame(std::uint32_t triangles) {
    sim::Frame frame = described_frame();
    add_surface(frame, triangles);
    return frame;
}
inline sim::Frame full_frame(std::size_t points, std::uint32_t triangles) {
    sim::Frame frame = described_frame();
    add_points(frame, points);
    add_surface(frame, triangles);
    return frame;
}

/// Bits, so that NaN equals NaN and zero is not minus zero.
inline std::vector<std::uint64_t> bits(const std::vector<double>& values) {
    std::vector<std::uint64_t> all;
    for (const double v : values) all.push_back(std::bit_cast<std::uint64_t>(v));
    return all;
}
inline std::vector<std::uint64_t> bits(const std::vector<Vec3>& values) {
    std::vector<std::uint64_t> all;
    for (const Vec3& v : values) {
        for (std::size_t k = 0; k < 3; ++k) all.push_back(std::bit_cast<std::uint64_t>(v[k]));
    }
    return all;
}

inline void expect_same(const std::vector<sim::Field>& a, const std::vector<sim::Field>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_EQ(a[k].name, b[k].name);
        EXPECT_EQ(a[k].unit, b[k].unit) << a[k].name;
        EXPECT_EQ(a[k].components, b[k].components) << a[k].name;
        EXPECT_EQ(a[k].integer, b[k].integer) << a[k].name;
        EXPECT_EQ(bits(a[k].values), bits(b[k].values)) << a[k].name;
    }
}

inline void expect_same(const sim::Frame& a, const sim::Frame& b) {
    EXPECT_EQ(a.solver, b.solver);
    EXPECT_EQ(bits(std::vector{a.time}), bits(std::vector{b.time}));
    EXPECT_EQ(a.time_unit, b.time_unit);
    EXPECT_EQ(a.step, b.step);
    ASSERT_EQ(a.box.has_value(), b.box.has_value());
    if (a.box) {
        EXPECT_EQ(a.box->dimension, b.box->dimension);
        EXPECT_EQ(bits(std::vector{a.box->origin, a.box->lengths}), bits(std::vector{b.box->origin, b.box->lengths}));
        EXPECT_EQ(a.box->periodic, b.box->periodic);
    }
    ASSERT_EQ(a.scalars.size(), b.scalars.size());
    for (std::size_t k = 0; k < a.scalars.size(); ++k) {
        EXPECT_EQ(a.scalars[k].name, b.scalars[k].name);
        EXPECT_EQ(a.scalars[k].unit, b.scalars[k].unit);
        EXPECT_EQ(bits(std::vector{a.scalars[k].value}), bits(std::vector{b.scalars[k].value}));
        EXPECT_EQ(a.scalars[k].text, b.scalars[k].text);
    }
    EXPECT_EQ(bits(a.surface.position), bits(b.surface.position));
    EXPECT_EQ(a.surface.triangles, b.surface.triangles);
    EXPECT_EQ(a.surface.regions, b.surface.regions);
    expect_same(a.surface.vertex_fields, b.surface.vertex_fields);
    expect_same(a.surface.face_fields, b.surface.face_fields);
    expect_same(a.surface.region_fields, b.surface.region_fields);
    EXPECT_EQ(bits(a.points.position), bits(b.points.position));
    EXPECT_EQ(bits(a.points.radius), bits(b.points.radius));
    EXPECT_EQ(a.points.length_unit, b.points.length_unit);
    expect_same(a.points.fields, b.points.fields);
    ASSERT_EQ(a.solids.size(), b.solids.size());
    for (std::size_t i = 0; i < a.solids.size(); ++i) {
        EXPECT_EQ(bits(std::vector{a.solids[i].center}), bits(std::vector{b.solids[i].center}));
        EXPECT_EQ(a.solids[i].radius, b.solids[i].radius);
    }
}

}  // namespace lamella::test
