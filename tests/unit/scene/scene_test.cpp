#include "lamella/scene/scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "toy_solver.h"
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace lamella::scene {
namespace {

Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_scene(text, "foam.toml", overrides, toy::registry());
}

toy::Options toy_options(const Scene& scene) {
    const auto solver = create_solver(scene, toy::registry());
    return dynamic_cast<const toy::Solver&>(*solver).options;
}

std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        parse(text, overrides);
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "no error";
}

void expect_error(const std::string& text,
                  const std::string& expected,
                  const std::vector<std::string>& overrides = {}) {
    const std::string error = error_of(text, overrides);
    EXPECT_NE(error.find(expected), std::string::npos) << error;
}

TEST(Scene, HasDefaultsForEverythingButTheSolver) {
    const Scene scene = parse("solver = 'toy'");
    EXPECT_EQ(scene.solver, "toy");
    EXPECT_EQ(scene.seed, 1u);
    EXPECT_EQ(scene.time.end, 0.0);
    EXPECT_TRUE(scene.output.frames);
    EXPECT_TRUE(scene.notes.empty());
    EXPECT_EQ(toy_options(scene).count, 10);
}

TEST(Scene, ReadsEveryKindOfValue) {
    const Scene scene = parse(R"(
title = "A toy"
solver = "toy"
seed = 7
[time]
end = "20 ms"
frame_rate = "50 1/s"
series_rate = 100
[output]
frames = false
checkpoint_interval = "2 min"
[toy]
count = 1e5
big = 9007199254740993
fraction = 1
radius = "7 cm"
tilt = "0.25 rad"
fast = true
walls = [true, false, true]
label = "x"
[toy.flow]
color = "blue"
velocity = ["3 cm/s", 0, -1.5]
)");
    EXPECT_EQ(scene.title, "A toy");
    EXPECT_EQ(scene.seed, 7u);
    EXPECT_EQ(scene.time.end, 0.02);
    EXPECT_EQ(scene.time.frame_rate, 50.0);
    EXPECT_EQ(scene.time.series_rate, 100.0);
    EXPECT_FALSE(scene.output.frames);
    EXPECT_EQ(scene.output.checkpoint_interval, 120.0);
    const toy::Options options = toy_options(scene);
    EXPECT_EQ(options.count, 100000);
    EXPECT_EQ(options.big, 9007199254740993);
    EXPECT_EQ(options.fraction, 1.0);
    EXPECT_EQ(options.radius, 0.07);
    EXPECT_DOUBLE_EQ(options.tilt, 0.25 * 180.0 / M_PI);
    EXPECT_TRUE(options.fast);
    EXPECT_EQ(options.walls, (std::array<bool, 3>{true, false, true}));
    EXPECT_EQ(options.label, "x");
    EXPECT_EQ(options.flow.color, toy::Color::kBlue);
    EXPECT_EQ(options.flow.velocity, (Vec3{{0.03, 0.0, -1.5}}));
}

TEST(Scene, TakesPlainTimesWhereTheSolverHasNoSeconds) {
    EXPECT_EQ(parse("solver = 'still'\n[time]\nend = 20").time.end, 20.0);
    expect_error("solver = 'still'\n[time]\nend = '20 s'",
                 "foam.toml:3: time.end = \"20 s\" is a string; a plain number");
    expect_error("solver = 'toy'\n[time]\nend = '20 m'",
                 "foam.toml:3: time.end = \"20 m\" is a length [m]; a time [s]");
}

TEST(Scene, NotesTablesOfOtherSolvers) {
    const Scene scene = parse("solver = 'toy'\n[still]\nanything = 1");
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_EQ(scene.notes[0], "[still] is not used by solver toy");
}

TEST(Scene, ReportsErrorsInTheOrderOfTheFile) {
    expect_error("solver = 'toy'\nzeta = 1\nalpha = 1", "foam.toml:2: zeta");
    expect_error("solver = 'toy'\n[toy]\nzeta = 1\nalpha = 1", "foam.toml:3: toy.zeta");
    expect_error("solver = 'toy'\n[toy.flow]\nzeta = 1\n[toy]\nalpha = 1", "foam.toml:3: toy.flow.zeta");
}

TEST(Scene, OverridesValuesFromTheCommandLine) {
    const std::string text = "solver = 'toy'\n[toy]\ncount = 5\nlabel = 'x'";
    const Scene scene = parse(text, {"toy.count=7", "toy.label=plain words", "toy.flow.velocity=[1, '2 cm/s', 3]",
                                     "seed=9", "toy.flow.color=red", "title = \"A = B\"", "time.end=1 min"});
    const toy::Options options = toy_options(scene);
    EXPECT_EQ(options.count, 7);
    EXPECT_EQ(options.label, "plain words");
    EXPECT_EQ(options.flow.velocity, (Vec3{{1.0, 0.02, 3.0}}));
    EXPECT_EQ(options.flow.color, toy::Color::kRed);
    EXPECT_EQ(scene.seed, 9u);
    EXPECT_EQ(scene.time.end, 60.0);
    EXPECT_EQ(toy_options(parse(text, {"toy.label=1\nb = 2"})).label, "1\nb = 2");
    EXPECT_EQ(toy_options(parse(text, {"toy.label=2020-02-02"})).label, "2020-02-02");
    EXPECT_EQ(toy_options(parse(text, {"toy.label="})).label, "");
}

TEST(Scene, RefusesOverridesThatMakeNoSense) {
    const std::string text = "solver = 'toy'\n[toy]\ncount = 5";
    expect_error(text, "--set toy.count=-1: toy.count = -1 is outside [1, 2000000000]", {"toy.count=-1"});
    expect_error(text, "--set toy.count=many: toy.count = \"many\" is a string", {"toy.count=many"});
    expect_error(text, "--set toy.cuont=1: toy.cuont is not an option; did you mean toy.count?", {"toy.cuont=1"});
    expect_error(text, "--set toy.count: there is no '='", {"toy.count"});
    expect_error(text, "the key must be names joined by dots", {"toy..count=1"});
    expect_error(text, "the key must be names joined by dots", {"=1"});
    expect_error(text, "the key must be names joined by dots", {"toy.a b=1"});
    expect_error(text, "toy.count is an integer, not a table", {"toy.count.x=1"});
    expect_error(text, "not UTF-8", {"toy.label=\xff"});
    expect_error(text, "the key must be", {std::string(100000, 'a') + "=1"});
    expect_error(text, "the key must be", {"a\nb=1"});
    EXPECT_EQ(error_of(text, {"a\nb=1"}).find('\n'), std::string::npos);
}

TEST(Scene, SaysWhichSolversThereAre) {
    expect_error("title = 'x'", "foam.toml: solver is missing");
    expect_error("title = 'x'", "known are \"toy\", \"still\", \"bubble\"");
    expect_error("solver = 'vortex'", "foam.toml:1: solver = \"vortex\" is no solver of this build; known are \"toy\"");
    expect_error("solver = 'toi'", "did you mean \"toy\"?");
    expect_error("", "foam.toml: the scene is empty");
    expect_error("solver = 'toy'\ntoy = 3", "foam.toml:2: toy = 3 is an integer; a table is expected");
}

TEST(ResolvedScene, HasFileNamesThatDoNotDependOnWhereItStands) {
    const Scene scene =
        parse_scene("solver = 'toy'\n[toy]\nfile = '../a.csv'", "/some/where/foam.toml", {}, toy::registry());
    const Scene again = parse_scene(resolved_toml(scene, toy::registry()), "/else/run.toml", {}, toy::registry());
    EXPECT_EQ(toy_options(again).file, "/some/a.csv");
}

TEST(ResolvedScene, ExplainsEveryLine) {
    const std::string text = resolved_toml(parse("solver = 'toy'"), toy::registry());
    EXPECT_NE(text.find("count = 10                              # bubbles at the start\n"), std::string::npos) << text;
    EXPECT_NE(text.find("radius = 0.05                           # [m] of a bubble\n"), std::string::npos) << text;
    EXPECT_NE(text.find("color = \"green\"                         # red | green | blue; a color\n"), std::string::npos)
        << text;
    EXPECT_NE(text.find("[toy.flow]                              # a prescribed flow\n"), std::string::npos) << text;
}

/// A number of any size and sign, all bits in use.
double any_double(std::mt19937_64& random) {
    const double mantissa = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
    return std::ldexp(mantissa, std::uniform_int_distribution<int>(-1000, 1000)(random));
}

/// Text with everything that needs care in TOML.
std::string any_text(std::mt19937_64& random) {
    static const std::vector<std::string> kPieces{"a", " ", "\"",   "\\",   "\n",     "\t",        "#",
                                                  "'", "=", "\x01", "\x7f", "\u00e9", "\U0001f9fc"};
    std::string text;
    for (std::size_t i = random() % 12; i > 0; --i) text += kPieces[random() % kPieces.size()];
    return text;
}

TEST(ResolvedScene, ReadsBackToTheSameSceneWhateverItHolds) {
    std::mt19937_64 random(7);
    for (int i = 0; i < 500; ++i) {
        Scene scene = parse("solver = 'toy'");
        scene.title = any_text(random);
        scene.seed = random() >> 1;
        scene.time.end = std::abs(any_double(random));
        scene.time.frame_rate = scene.time.end > 1.0 ? 1.0 / scene.time.end : 0.1;
        scene.output.checkpoint_interval = std::abs(any_double(random));
        toy::Options options;
        options.big = static_cast<std::int64_t>(random());
        options.fraction = std::uniform_real_distribution<double>(0.0, 1.0)(random);
        options.radius = std::abs(any_double(random)) + 1e-300;
        options.label = any_text(random);
        options.flow.velocity = {{any_double(random), any_double(random), -0.0}};
        scene.root.set("toy", sim::resolve_options(options, "toy"));

        const std::string text = resolved_toml(scene, toy::registry());
        const Scene again = parse(text);
        EXPECT_EQ(resolved_toml(again, toy::registry()), text);
        EXPECT_EQ(again.title, scene.title);
        EXPECT_EQ(again.seed, scene.seed);
        EXPECT_EQ(again.time.end, scene.time.end);
        EXPECT_EQ(again.time.frame_rate, scene.time.frame_rate);
        EXPECT_EQ(again.output.checkpoint_interval, scene.output.checkpoint_interval);
        const toy::Options read = toy_options(again);
        EXPECT_EQ(read.big, options.big);
        EXPECT_EQ(read.fraction, options.fraction);
        EXPECT_EQ(read.radius, options.radius);
        EXPECT_EQ(read.label, options.label);
        EXPECT_EQ(read.flow.velocity, options.flow.velocity);
        EXPECT_TRUE(std::signbit(read.flow.velocity[2]));
    }
}

TEST(Scene, LivesThroughNestingInEveryForm) {
    const auto repeated = [](const std::string& piece) {
        std::string text;
        for (int i = 0; i < 100000; ++i) text += piece;
        return text;
    };
    for (const std::string& text :
         {repeated("a."), "a = " + repeated("["), "a = " + repeated("{a="), "[" + repeated("a.") + "a]",
          "[[" + repeated("a.") + "a]]", repeated("\"a\"."), repeated("'a' . "), "a = {" + repeated("a.") + "a=1}",
          "a = '''\n'''\n" + repeated("a."), "a = \"\\\"\"\n" + repeated("b."), "# '\n" + repeated("a.")})
        expect_error(text, "nested deeper than 32 levels");
    // Dots and brackets in strings and comments are no nesting.
    EXPECT_NO_THROW(
        parse("title = \"" + repeated("a.").substr(0, 1000) + "\" # " + repeated("[") + "\nsolver = 'toy'"));
    EXPECT_NO_THROW(parse("title = \"\"\"" + repeated("[\n").substr(0, 1000) + "\"\"\"\"\"\nsolver = 'toy'"));
    EXPECT_NO_THROW(parse("title = '''" + repeated("{\n").substr(0, 1000) + "'''''\nsolver = 'toy'"));
}

TEST(Scene, AcceptsLettersOfEveryAlphabet) {
    EXPECT_EQ(parse("title = \"\"\"a\\\n  \u00e9t\u00e9\"\"\" # \u00f8\nsolver = 'toy'").title, "a\u00e9t\u00e9");
    expect_error("title = \u201cFoam\u201d\nsolver = 'toy'", "foam.toml:1: ");
    expect_error("solver = 'toy'\u00e9", "foam.toml:1: ");
}

TEST(Scene, AcceptsAByteOrderMarkAndWindowsLineEnds) {
    EXPECT_EQ(parse("\xef\xbb\xbfsolver = 'toy'\r\nseed = 3\r\n").seed, 3u);
}

}  // namespace
}  // namespace lamella::scene
