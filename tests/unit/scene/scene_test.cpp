#include "lamella/scene/scene.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "toy_solver.h"

namespace lamella::scene {
namespace {

Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_scene(text, "foam.toml", overrides, toy::registry());
}

toy::Options toy_options(const Scene& scene) {
    const auto solver = create_solver(scene, toy::registry());
    return dynamic_cast<const toy::Solver&>(*solver).options;
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

}  // namespace
}  // namespace lamella::scene
