#include "view/frame_message.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "films.h"
#include "view/colors.h"
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace lamella::app::view {
namespace {

std::uint32_t number_at(const std::string& bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

nlohmann::json header_of(const std::string& bytes) {
    return nlohmann::json::parse(bytes.substr(16, number_at(bytes, 8)));
}

/// One array as floats.
std::vector<float> floats(const std::string& bytes, const std::string& set, const std::string& name) {
    const nlohmann::json header = header_of(bytes);
    for (const auto& array : header.at("arrays"))
        if (array.at("set") == set && array.at("name") == name) {
            EXPECT_EQ(array.at("type"), "f32");
            std::vector<float> values(array.at("count").get<std::size_t>() * array.at("components").get<std::size_t>());
            const std::size_t start = 16 + number_at(bytes, 8) + array.at("offset").get<std::size_t>();
            std::memcpy(values.data(), bytes.data() + start, values.size() * sizeof(float));
            return values;
        }
    ADD_FAILURE() << "no " << set << "/" << name;
    return {};
}

TEST(FrameMessage, HoldsWhatTheHeaderSays) {
    sim::Frame frame = three_sheets(4);
    frame.surface = with_outside(frame.surface);
    frame.time = 0.25;
    frame.scalars.push_back({"energy", "J", std::numeric_limits<double>::quiet_NaN(), "of the films"});
    DetailLimits as_it_is;
    as_it_is.smooth = 0;
    const std::string bytes = frame_message(frame, as_it_is);
    EXPECT_EQ(bytes.substr(0, 4), "LMLA");
    EXPECT_EQ(number_at(bytes, 4), 1u);
    EXPECT_EQ(16u + number_at(bytes, 8) + number_at(bytes, 12), bytes.size());
    const nlohmann::json header = header_of(bytes);
    EXPECT_EQ(header.at("time"), 0.25);
    EXPECT_TRUE(header.at("scalars").at(0).at("value").is_null());
    EXPECT_EQ(header.at("triangles").at("all"), 96);
    const std::vector<float> position = floats(bytes, "vertices", "position"),
                             height = floats(bytes, "vertex_fields", "height");
    ASSERT_EQ(position.size(), 3u * 75u);
    ASSERT_EQ(height.size(), 75u);
    for (std::size_t v = 0; v < height.size(); ++v) EXPECT_EQ(height[v], position[3 * v + 2]);
    EXPECT_EQ(floats(bytes, "face_fields", "sheet").size(), 96u);
    EXPECT_EQ(floats(bytes, "borders", "segment").size(), 4u * 6u);
}

TEST(FrameMessage, CutsCoarseFilmsIntoPiecesWithTheirValues) {
    const std::string bytes = frame_message(three_sheets(4));  // 96 triangles, 16 pieces each
    EXPECT_EQ(header_of(bytes).at("triangles").at("shown"), 96);
    EXPECT_EQ(floats(bytes, "face_fields", "sheet").size(), 16u * 96u);
    const std::vector<float> position = floats(bytes, "vertices", "position"),
                             height = floats(bytes, "vertex_fields", "height");
    ASSERT_EQ(position.size(), 3 * height.size());
    for (std::size_t v = 0; v < height.size(); ++v)
        EXPECT_NEAR(height[v], position[3 * v + 2], 1e-6);  // single precision
}

TEST(FrameMessage, KeepsWholeNumbersWhole) {
    sim::Frame frame = three_sheets(1);
    sim::Field label{"label", "-", 1, true, {}};
    for (std::size_t v = 0; v < frame.surface.position.size(); ++v) label.values.push_back(double(10 * v));
    frame.surface.vertex_fields.push_back(label);
    for (const float value : floats(frame_message(frame), "vertex_fields", "label"))
        EXPECT_EQ(std::fmod(value, 10.0f), 0.0f);
}

TEST(FrameMessage, HoldsSolids) {
    sim::Frame frame = three_sheets(1);
    EXPECT_EQ(frame_message(frame).find("\"solids\""), std::string::npos);
    frame.solids = {{{{1.0, 2.0, 3.0}}, 0.5}, {{{4.0, 5.0, 6.0}}, 0.25}};
    const std::string bytes = frame_message(frame);
    EXPECT_EQ(floats(bytes, "solids", "position"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(floats(bytes, "solids", "radius"), (std::vector<float>{0.5, 0.25}));
}

TEST(FrameMessage, ThinsOutAndSaysSo) {
    DetailLimits limits;
    limits.triangles = 200;
    const nlohmann::json header = header_of(frame_message(three_sheets(30), limits));
    EXPECT_EQ(header.at("triangles").at("all"), 5400);
    EXPECT_LE(header.at("triangles").at("shown"), 200);
}

TEST(FrameMessage, CarriesBallsWithTheirFields) {
    sim::Frame frame;
    frame.box = sim::Box{2, {}, {{4.0, 4.0, 0.0}}, {true, true, false}};
    frame.points.length_unit = "-";
    frame.points.position = {{{1.0, 2.0, 0.0}}, {{3.0, 2.0, 0.0}}};
    frame.points.radius = {0.5, 0.75};
    frame.points.fields.push_back({"velocity", "-", 3, false, {1, 2, 3, 4, 5, 6}});
    const std::string bytes = frame_message(frame);
    EXPECT_EQ(floats(bytes, "points", "radius"), (std::vector<float>{0.5f, 0.75f}));
    EXPECT_EQ(floats(bytes, "point_fields", "velocity"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(header_of(bytes).at("box").at("dimension"), 2);
}

TEST(FrameMessage, RefusesFieldsOfAnotherLength) {
    sim::Frame frame = three_sheets(2);
    frame.surface.face_fields[0].values.pop_back();
    EXPECT_THROW(frame_message(frame), InputError);
}

TEST(RegionsText, TellsTheNeighborsOfABubble) {
    // A tetrahedron, cut in two by nothing: one bubble that touches the outside alone.
    sim::Frame frame;
    frame.surface.position = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
    frame.surface.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    frame.surface.regions.assign(4, {1, 0});
    frame.surface.region_fields = {{"pressure", "Pa", 1, false, {0.0, 7.5}}};
    const nlohmann::json regions = nlohmann::json::parse(regions_text(frame)).at("regions");
    ASSERT_EQ(regions.size(), 1u);
    EXPECT_EQ(regions[0].at("id"), 1);
    EXPECT_NEAR(regions[0].at("volume").get<double>(), 1.0 / 6.0, 1e-15);
    EXPECT_EQ(regions[0].at("pressure"), 7.5);
    ASSERT_EQ(regions[0].at("neighbors").size(), 1u);
    EXPECT_EQ(regions[0].at("neighbors")[0].at("id"), 0);
}

TEST(ColorMessage, IsBlackWithoutThickness) {
    const std::string bytes = color_message();
    const nlohmann::json header = header_of(bytes);
    const std::vector<float> thin = floats(bytes, "colors", "thin");
    ASSERT_EQ(thin.size(), 3 * header.at("thicknesses").get<std::size_t>() * header.at("cosines").get<std::size_t>());
    const std::size_t head_on = thin.size() - 3 * header.at("thicknesses").get<std::size_t>();
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(thin[head_on + k], 0.0, 1e-7);  // single precision
    EXPECT_EQ(floats(bytes, "colors", "thick").size(), 3 * header.at("cosines").get<std::size_t>());
}

}  // namespace
}  // namespace lamella::app::view
