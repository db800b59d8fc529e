#include "lamella/scene/import.h"

#include "lamella/scene/detail/lenient_json.h"
#include "lamella/scene/scene.h"

#include <gtest/gtest.h>

#include "toy_solver.h"
#include <filesystem>
#include <string>

namespace lamella::scene {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(LAMELLA_SOURCE_DIR) / "tests/data/import";

Scene scene_from(const std::string& text) { return parse_scene(text, "imported.toml", {}, toy::registry()); }

bubble::Options options_of(const Scene& scene) {
    return sim::read_options<bubble::Options>(*scene.root.find("bubble"));
}

std::string error_of(const std::string& json) {
    try {
        import_foam_json_text(json, "in.json");
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "no error";
}

void expect_contains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "missing: " << part << "\nin: " << text;
}

TEST(ImportFoamJson, ReadsTheListingOfTheThesisAsPrinted) {
    const std::string text = import_foam_json(kData / "thesis-listing.json");
    const Scene scene = scene_from(text);
    EXPECT_EQ(scene.seed, 4u);
    EXPECT_EQ(scene.time.end, 0.0);
    EXPECT_EQ(scene.time.frame_rate, 1.0);
    const bubble::Options options = options_of(scene);
    EXPECT_EQ(options.dimension, 2);
    EXPECT_EQ(options.count, 100000);
    EXPECT_EQ(options.end_count, 300);
    EXPECT_EQ(options.mean_radius, 1.0);
    EXPECT_EQ(options.gas_fraction, 0.95);
    EXPECT_EQ(options.box_shape, (Vec3{{1.0, 1.0, 1.0}}));
    EXPECT_EQ(options.wall_drag, 0.1);
    EXPECT_EQ(options.surface_tension, 1.0);
    EXPECT_EQ(options.viscosity, 1.0);
    EXPECT_EQ(options.gas.exchange_rate, 1e-3);
    EXPECT_EQ(options.gas.medium_ratio, 0.1);
    EXPECT_EQ(options.start.radius_std, 0.21);
    EXPECT_EQ(options.integrator.method, bubble::Method::kRkc2);
    EXPECT_EQ(options.integrator.initial_step, 1e-3);
    EXPECT_EQ(options.flow.kind, bubble::FlowKind::kNone);
    EXPECT_EQ(options.flow.velocity, (Vec3{{0.01, 0.0, 0.0}}));
    EXPECT_EQ(options.flow.region_low, (Vec3{{0.0, 0.475, 0.0}}));
    EXPECT_EQ(options.flow.region_high, (Vec3{{1.0, 0.525, 0.0}}));
    expect_contains(text, "count = 100000                          # numBubblesIn\n");
    expect_contains(text, "bubble.integrator.tolerance = 1e-05");
    expect_contains(text, "bubble.compat.step_control = \"thesis\"");
    expect_contains(text, "#     numBubblesPerCell = 32 (");
    EXPECT_EQ(text.find("WARNING"), std::string::npos);
}

TEST(ImportFoamJson, ReadsCubblesNestedForm) {
    const std::string text = import_foam_json(kData / "cubble.json");
    const Scene scene = scene_from(text);
    EXPECT_EQ(scene.time.frame_rate, 2.5);
    const bubble::Options options = options_of(scene);
    EXPECT_EQ(options.dimension, 3);
    EXPECT_EQ(options.count, 20000);
    EXPECT_EQ(options.end_count, 1000);
    EXPECT_EQ(options.mean_radius, 1.5);
    EXPECT_EQ(options.start.radius_std, 0.3);
    EXPECT_EQ(options.gas_fraction, 0.9);
    EXPECT_EQ(options.viscosity, 2.0);
    EXPECT_EQ(options.surface_tension, 3.0);
    EXPECT_EQ(options.gas.medium_ratio, 0.2);
    EXPECT_EQ(options.gas.exchange_rate, 0.0005);
    EXPECT_EQ(options.box_shape, (Vec3{{2.0, 1.0, 1.0}}));
    EXPECT_EQ(options.walls, (std::array<bool, 3>{false, true, false}));
    EXPECT_EQ(options.wall_drag, 0.7);
    EXPECT_EQ(options.flow.kind, bubble::FlowKind::kRegion);
    // 0.01 times sigma <R_in> / mu = 3 * 1.5 / 2
    EXPECT_DOUBLE_EQ(options.flow.velocity[0], 0.0225);
    EXPECT_EQ(options.flow.region_low, (Vec3{{0.0, 0.475, 0.0}}));
    EXPECT_EQ(options.flow.region_high, (Vec3{{0.4, 0.525, 0.0}}));
    expect_contains(text, "# WARNING: keys that are unknown and were left out:\n#     line 38: colormap\n");
    expect_contains(text, "bubble.drag = \"neighbor_lagged\"");
    expect_contains(text, "bubble.compat.step_control = \"cubble\"");
}

TEST(ImportFoamJson, RefusesWrongValuesWithTheirLine) {
    EXPECT_EQ(
        error_of("{\n\"phiTarget\": 95}"),
        "in.json:2: phiTarget = 95 is outside (0, 2) (phi: volume of the balls / volume of the box, overlaps counted"
        " twice); as a fraction, 95 % is 0.95");
    expect_contains(error_of("{\"kappa\": 0.1,\n\n\"numBubblesIn\": 1.5}"),
                    "in.json:3: numBubblesIn = 1.5 is no whole number");
    expect_contains(error_of("{\"bubbles\": {\n\"numStart\": \"many\"}}"),
                    "in.json:2: bubbles.numStart = \"many\" is a string");
    expect_contains(error_of("{\"rngSeed\": -4}"), "in.json:1: rngSeed = -4 is not >= 0");
    expect_contains(error_of("{\"errorTolerance\": 0}"), "errorTolerance = 0 is not > 0");
    expect_contains(error_of("{\"boxRelDim\": {\"x\": 1, \"y\": 1}}"),
                    "boxRelDim must have x, y and z and nothing else");
    expect_contains(error_of("{\"boxRelDim\": {\"x\": 1, \"y\": -1, \"z\": 1}}"), "boxRelDim.y = -1 is not > 0");
    expect_contains(error_of("{\"box\": {\"wall\": {\"x\": 2}}}"), "box.wall.x = 2 is neither 0 nor 1");
    expect_contains(error_of("{\"flow\": {\"impose\": null}, \"kappa\": 1}"),
                    "flow.impose = nothing is neither 0 nor 1");
    expect_contains(error_of("{\"phiTarget\": 0.9,\n\"constants\": {\"phi\": 0.8}}"),
                    "in.json:2: constants.phi says again what phiTarget said on line 1");
    expect_contains(error_of("{\"solver\": \"x\"}"), "in.json: has none of the keys");
    expect_contains(error_of(""), "in.json:1: an object {...} is expected");
}

TEST(ImportFoamJson, KeepsHostileNamesInsideComments) {
    const std::string text = import_foam_json_text("{\"phiTarget\": 0.9, \"a\\nsolver = 3\\n\": 1}", "x\n[y].json");
    const Scene scene = scene_from(text);
    EXPECT_EQ(scene.title, "Imported from x\n[y].json");
    EXPECT_EQ(options_of(scene).gas_fraction, 0.9);
    EXPECT_NO_THROW(scene_from(import_foam_json_text("{\"phiTarget\": 0.9}", "\xff.json")));
}

TEST(ImportFoamJson, AMissingFileIsAnIoErrorAndADirectoryIsRefused) {
    EXPECT_THROW(import_foam_json(kData / "none.json"), IoError);
    EXPECT_THROW(import_foam_json(kData), InputError);
}

TEST(LenientJson, ReadsStandardJson) {
    const sim::Node root = detail::read_lenient_json(
        R"({"a": [1, -2.5, 1e5, true, false, null], "s": "\"\\\/\b\f\n\r\t\u00e9\ud83e\uddfc", "e": {}, "f": []})",
        "x");
    const sim::Node::Array& items = *root.find("a")->array();
    EXPECT_EQ(std::get<std::int64_t>(items[0].value), 1);
    EXPECT_EQ(std::get<double>(items[1].value), -2.5);
    EXPECT_EQ(std::get<double>(items[2].value), 1e5);
    EXPECT_TRUE(std::get<bool>(items[3].value));
    EXPECT_TRUE(std::holds_alternative<std::monostate>(items[5].value));
    EXPECT_EQ(std::get<std::string>(root.find("s")->value), "\"\\/\b\f\n\r\t\u00e9\U0001f9fc");
    EXPECT_EQ(root.find("e")->table()->size(), 0u);
    EXPECT_EQ(root.find("f")->array()->size(), 0u);
}

TEST(LenientJson, ForgivesAMissingCommaAndBrokenStrings) {
    const sim::Node root = detail::read_lenient_json("\xef\xbb\xbf{\n\"a\": \"two\r\nlines\"\n\"b\": 3}", "x");
    EXPECT_EQ(std::get<std::string>(root.find("a")->value), "two lines");
    EXPECT_EQ(std::get<std::int64_t>(root.find("b")->value), 3);
    EXPECT_EQ(root.find("b")->where.line, 4);
}

TEST(LenientJson, RefusesEverythingElseWithItsLine) {
    for (const char* text : {"[1]",
                             "{",
                             "{\"a\"",
                             "{\"a\": }",
                             "{\"a\": 1,}",
                             "{\"a\": 1,,\"b\": 2}",
                             "{\"a\" 1}",
                             "{a: 1}",
                             "{\"a\": 1} x",
                             "{\"a\": 1, \"a\": 2}",
                             "{\"a\": 1e999}",
                             "{\"a\": --1}",
                             "{\"a\": nan}",
                             "{\"a\": 0x1}",
                             "{\"a\": \"\\x\"}",
                             "{\"a\": \"\\u12\"}",
                             "{\"a\": \"\\ud800\"}",
                             "{\"a\": \"\\udc00\"}",
                             "{\"a\": \"\\ud800\\u0041\"}",
                             "{\"a\": \"open}",
                             "{\"a\": \"\x01\"}",
                             "{\"a\": \"\\",
                             "{\"a\": \"\xff\"}"})
        EXPECT_THROW(detail::read_lenient_json(text, "x"), InputError) << text;
    std::string deep = "{\"a\": ";
    for (int i = 0; i < 100000; ++i) deep += "[";
    EXPECT_THROW(detail::read_lenient_json(deep, "x"), InputError);
}

TEST(LenientJson, KnowsUtf8) {
    for (const char* good : {"", "a", "\u00e9", "\u20ac", "\U0001f9fc", "\uffff", "\U0010ffff"})
        EXPECT_TRUE(detail::is_utf8(good)) << good;
    for (const char* bad : {"\x80", "\xc0\x80", "\xc3", "\xe0\x80\x80", "\xed\xa0\x80", "\xf0\x80\x80\x80",
                            "\xf4\x90\x80\x80", "\xff", "\xe2\x82", "a\xe2\x28\xa1"})
        EXPECT_FALSE(detail::is_utf8(bad));
}

}  // namespace
}  // namespace lamella::scene
