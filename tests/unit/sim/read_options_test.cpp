#include "lamella/sim/read_options.h"

#include <gtest/gtest.h>

#include "../scene/toy_solver.h"
#include <cmath>
#include <limits>
#include <string>

namespace lamella::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// toy.<key> = value on line 12 of foam.toml; "flow.color" goes into the group.
Node table_with(std::string_view key, auto value) {
    Node table{Node::Table{}, {"foam.toml", 11, 1}, "toy"};
    Node* inner = &table;
    if (const std::size_t dot = key.find('.'); dot != std::string_view::npos) {
        inner = &table.set(key.substr(0, dot),
                           {Node::Table{}, {"foam.toml", 11, 1}, "toy." + std::string(key.substr(0, dot))});
        key.remove_prefix(dot + 1);
    }
    Node entry{std::move(value), {"foam.toml", 12, 1}, inner->path + "." + std::string(key)};
    if (auto* items = std::get_if<Node::Array>(&entry.value))
        for (std::size_t i = 0; i < items->size(); ++i) (*items)[i].path = entry.path + "[" + std::to_string(i) + "]";
    inner->set(key, std::move(entry));
    return table;
}

toy::Options read(std::string_view key, auto value) {
    return read_options<toy::Options>(table_with(key, std::move(value)));
}

std::string error_of(std::string_view key, auto value) {
    try {
        read(key, std::move(value));
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "no error";
}

Node::Array array(auto... values) {
    Node::Array items;
    (items.push_back({values, {"foam.toml", 12, 1}, {}}), ...);
    return items;
}

TEST(ReadOptions, GivesTheDefaultsForNothingAndForAnEmptyTable) {
    for (const Node& table : {Node{}, Node{Node::Table{}, {}, {}}}) {
        const auto options = read_options<toy::Options>(table);
        EXPECT_EQ(options.count, 10);
        EXPECT_EQ(options.flow.color, toy::Color::kGreen);
    }
}

TEST(ReadOptions, TakesWholeNumbersForNumbersAndWholeFloatsForCounts) {
    EXPECT_EQ(read("radius", std::int64_t{3}).radius, 3.0);
    EXPECT_EQ(read("count", 1e5).count, 100000);
    EXPECT_EQ(read("big", std::numeric_limits<std::int64_t>::min()).big, std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(read("big", std::numeric_limits<std::int64_t>::max()).big, std::numeric_limits<std::int64_t>::max());
}

TEST(ReadOptions, ConvertsUnitsToThoseOfTheOption) {
    EXPECT_EQ(read("radius", std::string("5 cm")).radius, 0.05);
    EXPECT_DOUBLE_EQ(read("tilt", std::string("1 rad")).tilt, 180.0 / M_PI);
    EXPECT_EQ(read("tilt", 30.0).tilt, 30.0);
    EXPECT_EQ(read("flow.velocity", array(std::string("3 cm/s"), 0.0, std::int64_t{1})).flow.velocity,
              (Vec3{{0.03, 0.0, 1.0}}));
}

TEST(ReadOptions, TakesUnitsForModelQuantitiesOnlyWhereTheModelHasThem) {
    const Node table = table_with("flow.tolerance", std::string("2 mm"));
    EXPECT_EQ(read_options<toy::Options>(table, {.length = "m"}).flow.tolerance, 0.002);
    EXPECT_NE(error_of("flow.tolerance", std::string("2 mm")).find("a plain number without unit is expected"),
              std::string::npos);
}

TEST(ReadOptions, NamesPlaceKeyFoundAndAllowed) {
    EXPECT_EQ(
        error_of("fraction", std::int64_t{90}),
        "foam.toml:12: toy.fraction = 90 is outside [0, 1] (gas volume / box volume); as a fraction, 90 % is 0.9");
    EXPECT_EQ(error_of("fraction", -0.5),
              "foam.toml:12: toy.fraction = -0.5 is outside [0, 1] (gas volume / box volume)");
    EXPECT_EQ(error_of("radius", 0.0), "foam.toml:12: toy.radius = 0 is not > 0 (of a bubble)");
    EXPECT_EQ(error_of("radius", std::string("5 kg")),
              "foam.toml:12: toy.radius = \"5 kg\" is a mass [kg]; a length [m] is expected, e.g. \"5 cm\"");
    EXPECT_EQ(error_of("radius", std::string("-5 cm")),
              "foam.toml:12: toy.radius = \"-5 cm\" is not > 0 (of a bubble)");
    EXPECT_EQ(error_of("radius", true),
              "foam.toml:12: toy.radius = true is a boolean; a number is expected (of a bubble)");
    EXPECT_EQ(error_of("fast", std::int64_t{1}),
              "foam.toml:12: toy.fast = 1 is an integer; true or false is expected (hurry)");
    EXPECT_EQ(error_of("label", 1.5), "foam.toml:12: toy.label = 1.5 is a number; a string is expected (free text)");
    EXPECT_EQ(error_of("flow.color", std::string("gren")),
              "foam.toml:12: toy.flow.color = \"gren\" is not one of red | green | blue; did you mean \"green\"?");
    EXPECT_EQ(error_of("flow.color", std::string("mauve")),
              "foam.toml:12: toy.flow.color = \"mauve\" is not one of red | green | blue (a color)");
    EXPECT_EQ(error_of("flow", std::int64_t{3}),
              "foam.toml:12: toy.flow = 3 is an integer; a table [toy.flow] is expected (a prescribed flow)");
    EXPECT_EQ(error_of("walls", array(true)),
              "foam.toml:12: toy.walls = [true] has 1 entries; 3 booleans are expected (walls per axis)");
    EXPECT_EQ(error_of("walls", array(true, true, 0.0)),
              "foam.toml:12: toy.walls[2] = 0 is a number; true or false is expected (walls per axis)");
    EXPECT_EQ(error_of("flow.velocity", 1.0),
              "foam.toml:12: toy.flow.velocity = 1 is a number; an array of 3 numbers is expected (of the liquid)");
}

TEST(ReadOptions, RefusesNumbersThatAreNotFiniteOrDoNotFit) {
    for (const double value : {kInfinity, -kInfinity, std::nan("")}) {
        EXPECT_NE(error_of("radius", value).find("is not a finite number"), std::string::npos);
        EXPECT_NE(error_of("big", value).find("is not a finite number"), std::string::npos);
        EXPECT_NE(error_of("flow.velocity", array(0.0, value, 0.0)).find("is not a finite number"), std::string::npos);
    }
    EXPECT_NE(error_of("count", std::int64_t{3'000'000'000}).find("outside [1, 2000000000]"), std::string::npos);
    EXPECT_NE(error_of("big", 1e19).find("too large; at most 9223372036854775807"), std::string::npos);
    EXPECT_NE(error_of("big", -1e300).find("too large; at most"), std::string::npos);
    EXPECT_NE(error_of("count", 2.5).find("is no whole number"), std::string::npos);
}

TEST(ReadOptions, SuggestsTheRightNameOrTheRightPlace) {
    EXPECT_EQ(error_of("cuont", std::int64_t{1}), "foam.toml:12: toy.cuont is not an option; did you mean toy.count?");
    EXPECT_EQ(error_of("color", std::int64_t{1}),
              "foam.toml:12: toy.color is not an option; did you mean toy.flow.color?");
    EXPECT_EQ(error_of("flow.velosity", std::int64_t{1}),
              "foam.toml:12: toy.flow.velosity is not an option; did you mean toy.flow.velocity?");
    EXPECT_EQ(error_of("flow.count", std::int64_t{1}),
              "foam.toml:12: toy.flow.count is not an option; did you mean toy.count?");
    EXPECT_EQ(error_of("flow.zzz", std::int64_t{1}),
              "foam.toml:12: toy.flow.zzz is not an option; known are color, velocity, tolerance");
}

TEST(ReadOptions, RefusesATableThatIsNone) {
    EXPECT_THROW(read_options<toy::Options>(Node{std::int64_t{3}, {}, "toy"}), InputError);
}

TEST(DescribeOptions, ListsEveryOptionWithDefaultAndRange) {
    const std::vector<OptionInfo> infos = describe_options<toy::Options>();
    ASSERT_EQ(infos.size(), 13u);
    EXPECT_EQ(infos[0].name, "count");
    EXPECT_EQ(infos[0].type, "integer");
    EXPECT_EQ(infos[0].default_text, "10");
    EXPECT_EQ(infos[0].allowed, "[1, 2000000000]");
    EXPECT_EQ(infos[3].name, "radius");
    EXPECT_EQ(infos[3].allowed, "> 0");
    EXPECT_EQ(infos[3].doc.unit, "m");
    EXPECT_EQ(infos[3].doc.source, "[Key, eq. 3]");
    EXPECT_EQ(infos[6].type, "3 booleans");
    EXPECT_EQ(infos[6].default_text, "[false, true, false]");
    EXPECT_EQ(infos[9].name, "flow");
    EXPECT_EQ(infos[9].type, "group");
    EXPECT_EQ(infos[10].name, "flow.color");
    EXPECT_EQ(infos[10].type, "word");
    EXPECT_EQ(infos[10].default_text, "\"green\"");
    EXPECT_EQ(infos[10].allowed, "red | green | blue");
    EXPECT_EQ(infos[11].default_text, "[0.5, 0, 0]");
}

TEST(ResolveOptions, GivesATableThatReadsBackTheSame) {
    toy::Options options;
    options.big = std::numeric_limits<std::int64_t>::min();
    options.radius = 0.1 + 0.2;
    options.label = "a \"b\"\n";
    options.walls = {true, true, false};
    options.flow.color = toy::Color::kRed;
    options.flow.velocity = {{-0.0, 1e-300, 1.0 / 3.0}};
    const Node table = resolve_options(options, "toy");
    EXPECT_EQ(table.table()->size(), 10u);
    EXPECT_EQ(table.find("flow")->find("color")->path, "toy.flow.color");
    const auto again = read_options<toy::Options>(table);
    EXPECT_EQ(again.big, options.big);
    EXPECT_EQ(again.radius, options.radius);
    EXPECT_EQ(again.label, options.label);
    EXPECT_EQ(again.walls, options.walls);
    EXPECT_EQ(again.flow.color, options.flow.color);
    EXPECT_EQ(again.flow.velocity, options.flow.velocity);
    EXPECT_TRUE(std::signbit(again.flow.velocity[0]));
}

TEST(RangeText, ReadsAsInABook) {
    EXPECT_EQ(range_text(between(0, 1)), "[0, 1]");
    EXPECT_EQ(range_text(strictly_between(0, 2)), "(0, 2)");
    EXPECT_EQ(range_text(at_least(1)), ">= 1");
    EXPECT_EQ(range_text(more_than(0)), "> 0");
    EXPECT_EQ(range_text(any_number()), "");
    EXPECT_EQ(range_text({.high = 3.0, .high_open = true}), "< 3");
}

}  // namespace
}  // namespace lamella::sim
