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

std::string films(const std::string& name) { return std::string(LAMELLA_SOURCE_DIR) + "/tests/data/films/" + name; }

TEST(FilmTables, FilmsOfAFileAreScaledMovedAndRefined) {
    const Scene scene = parse("[[film]]\nshape = \"mesh\"\nfile = \"" + films("box.fe") +
                              "\"\nscale = 0.01\ncenter = [1.0, 0, 0]\n[resolution]\nedge_length = \"5 mm\"\n");
    const mesh::FoamMesh& mesh = scene.films->mesh;
    ASSERT_EQ(mesh.regions.size(), 8U);
    EXPECT_DOUBLE_EQ(mesh.regions[mesh::RegionId{7}].target_volume, 8e-6);
    EXPECT_NEAR(mesh::region_volumes(mesh)[mesh::RegionId{7}], 6e-6 * std::sqrt(2.0), 1e-18);
    EXPECT_EQ(mesh.faces.size(), 24U * 16U);
    for (const Vec3& x : mesh.position) {
        EXPECT_GE(x[0], 1.0);
        EXPECT_LE(x[0], 1.02 + 1e-12);
    }
    EXPECT_EQ(scene.films->edge_length, 0.005);
}

TEST(FilmTables, FilmsOfAFileAreFoundAgainFromElsewhere) {
    const auto registry = all_solvers();
    const std::string text = "solver = \"equilibrium\"\n[[film]]\nshape = \"mesh\"\nfile = \"kelvin.fe\"\n";
    const Scene scene = parse_scene(text, films("s.toml"), {}, registry);
    const Scene again = parse_scene(resolved_toml(scene, registry), "/else/resolved.toml", {}, registry);
    EXPECT_EQ(again.films->mesh, scene.films->mesh);
    EXPECT_TRUE(again.films->mesh.periodic());
    ASSERT_EQ(film_files(again).size(), 1U);
    EXPECT_EQ(film_files(again)[0].name, "film_1.fe");
    EXPECT_EQ(film_files(again)[0].path, films("kelvin.fe"));
    EXPECT_NE(resolved_toml(scene, registry, FileNames::kCopies).find("file = \"film_1.fe\""), std::string::npos);
}

TEST(FilmTables, FilesThatAreWrongAreNamedWithTheirTable) {
    const auto says = [](const std::string& text, const std::string& what) {
        EXPECT_NE(complaint(text).find(what), std::string::npos) << complaint(text) << " | " << what;
    };
    says("[[film]]\nshape = \"mesh\"\n", "s.toml:2: film: shape = \"mesh\" needs file");
    says("[[film]]\nfile = \"a.fe\"\n", "film.file goes with shape = \"mesh\" only");
    says("[[film]]\nshape = \"mesh\"\nfile = \"a.stl\"\n", "a.stl: is no file of films");
    says("[[film]]\nshape = \"mesh\"\nfile = \"" + films("../malformed_meshes/bad_index.fe") + "\"\n",
         "bad_index.fe:10: edge 3: there is no vertex 9");
    says("[[film]]\nshape = \"mesh\"\nfile = \"" + films("box.fe") + "\"\n[resolution]\nedge_length = 1e-5\n", "2e7 faces");
    EXPECT_THROW(parse("[[film]]\nshape = \"mesh\"\nfile = \"none.fe\"\n"), IoError);
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
