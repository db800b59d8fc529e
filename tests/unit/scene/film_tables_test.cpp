#include "lamella/scene/film_tables.h"

#include "lamella/core/error.h"
#include "lamella/mesh/volume.h"
#include "lamella/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace lamella::scene {
namespace {

Scene parse(const std::string& text) { return parse_scene("solver = \"equilibrium\"\n" + text, "s.toml", {}, all_solvers()); }

std::string complaint(const std::string& text) {
    try {
        parse(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no complaint";
}

TEST(FilmTables, SeparateBubblesAreSpheresOfTheirVolumes) {
    const Scene scene = parse("[[bubble]]\nradius = \"5 cm\"\n[[bubble]]\ncenter = [\"20 cm\", 0, 0]\nvolume = 1e-4\n");
    const film::Problem& films = *scene.films;
    ASSERT_EQ(films.mesh.regions.size(), 3U);
    EXPECT_DOUBLE_EQ(films.mesh.regions[mesh::RegionId{2}].target_volume, 1e-4);
    EXPECT_NEAR(films.mesh.regions[mesh::RegionId{1}].target_volume, 4.0 / 3.0 * 3.14159265358979 * 0.000125, 1e-12);
    EXPECT_NEAR(films.edge_length, 0.25 * std::cbrt(0.75e-4 / 3.14159265358979), 1e-9);  // of the smaller one
}

TEST(FilmTables, ResolvedSceneGivesTheSameFilms) {
    const std::string text = R"(
seed = 5
[material]
surface_tension = "20 mN/m"
[[bubble]]
center = ["1 m", 0, 0]
radius = "3 cm"
[[film]]
shape = "frame"
frame = "octahedron"
center = ["-1 m", 0, 0]
edge = "10 cm"
[foam]
count = 4
volume = "20 cm^3"
sizes = "lognormal"
[[tension]]
a = 0
b = 1
factor = 1.5
[[event]]
time = "2 s"
kind = "inflate"
region = 1
factor = 2.0
)";
    const Scene scene = parse(text);
    const auto registry = all_solvers();
    const Scene again = parse_scene(resolved_toml(scene, registry), "resolved.toml", {}, registry);
    EXPECT_EQ(again.films->mesh, scene.films->mesh);
    EXPECT_EQ(again.films->edge_length, scene.films->edge_length);
    EXPECT_EQ(again.films->events.size(), 1U);
    EXPECT_EQ(again.films->events[0].volume, scene.films->events[0].volume);
    EXPECT_EQ(again.films->tensions[0].factor, 1.5);
    EXPECT_DOUBLE_EQ(again.films->material.film_tension(), 0.04);
    EXPECT_EQ(resolved_toml(again, registry), resolved_toml(scene, registry));
}

TEST(FilmTables, ComplaintsNameThePlace) {
    const auto says = [](const std::string& text, const std::string& what) {
        EXPECT_NE(complaint(text).find(what), std::string::npos) << complaint(text) << " | " << what;
    };
    says("", "the scene has no films");
    says("[[bubble]]\ncenter = [0, 0, 0]\n", "s.toml:2");
    says("[[bubble]]\nradius = \"5 kg\"\n", "s.toml:3");
    says("[[bubble]]\nradios = 5\n", "radius");
    says("[[film]]\nshape = \"donut\"\n", "disk");
    says("[[film]]\nshape = \"catenoid\"\nradius = 1.0\nseparation = 1.4\n", "no catenoid");
    says("[film]\nshape = \"disk\"\n", "[[film]]");
    says("[foam]\ncount = 0\n", "s.toml:3");
    says("[[bubble]]\nradius = 1.0\n[resolution]\nedge_length = 1e-9\n", "2e7");
    says("[[bubble]]\nradius = 1.0\n[[event]]\nregion = 2\n", "event.region = 2 is no bubble");
    says("[[bubble]]\nradius = 1.0\n[[event]]\nregion = 1\ninto = 7\n", "event.into = 7");
    says("[[bubble]]\nradius = 1.0\n[[tension]]\na = 0\nb = 9\n", "tension");
    says("[materials]\n[[bubble]]\nradius = 1.0\n", "material");
    says("[[film]]\nshape = \"kelvin\"\nvolume = 1.0\n[[bubble]]\nradius = 1.0\n", "periodic");
}

TEST(FilmTables, AreNoPartOfASceneForBubbles) {
    EXPECT_THROW(parse_scene("solver = \"bubble\"\n[foam]\ncount = 3\n", "s.toml", {}, all_solvers()), InputError);
    EXPECT_THROW(parse_scene("solver = \"bubble\"\n[[bubble]]\nradius = 3.0\n", "s.toml", {}, all_solvers()), InputError);
    // The other way round a table [bubble] is the options of that solver: noted and left alone.
    const Scene scene = parse("[bubble]\ncount = 5\n[[film]]\nshape = \"disk\"\n");
    EXPECT_EQ(scene.notes.size(), 1U);
}

}  // namespace
}  // namespace lamella::scene
