#pragma once

// The tables of a scene that say which films there are, shared by all film solvers. docs/equilibrium.md shows them.

#include "lamella/film/problem.h"
#include "lamella/mesh/shapes/wire_films.h"
#include "lamella/sim/options.h"
#include "lamella/sim/registry.h"

#include <string>
#include <vector>

namespace lamella::scene {

/// [material]
struct MaterialTable : film::Material {
    template <class Visitor>
    void visit(Visitor&& option) {
        option("surface_tension", surface_tension, sim::more_than(0.0),
               {"of ONE liquid-air interface; a film has two", "mass/time^2"});
        option("air_density", air_density, sim::at_least(0.0), {"of the gas on both sides", "mass/length^3"});
        option("thickness", thickness, sim::more_than(0.0), {"of the film", "length"});
        option("gravity", gravity, sim::any_number(), {"acceleration", "length/time^2"});
        option("liquid_density", liquid_density, sim::more_than(0.0), {"of the liquid in the film", "mass/length^3"});
        option("kinematic_viscosity", kinematic_viscosity, sim::at_least(0.0), {"of that liquid", "length^2/time"});
        option("surface_viscosity", surface_viscosity, sim::at_least(0.0), {"of each interface", "mass/time"});
        option("temperature", temperature, sim::more_than(0.0), {"of the film", "K"});
        option("surfactant", surfactant, sim::at_least(0.0),
               {"per area of one interface, at the start; this, elasticity or elastic_wave_speed; none: 4e-6 mol/m^2",
                "mol/length^2"});
        option("elasticity", elasticity, sim::at_least(0.0),
               {"of one interface, gas constant * temperature * surfactant", "mass/time^2"});
        option("elastic_wave_speed", elastic_wave_speed, sim::at_least(0.0),
               {"of waves of thickness: sqrt(2 elasticity / (liquid_density thickness))", "length/time"});
    }
};

/// [resolution]
struct ResolutionTable {
    double edge_length = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("edge_length", edge_length, sim::at_least(0.0),
               {"of the triangles; 0: a quarter of the smallest bubble's radius, or a twentieth of the films' size",
                "length"});
    }
};

/// One [[bubble]]
struct BubbleTable {
    Vec3 center;
    double radius = 0.0;
    double volume = 0.0;
    Vec3 velocity;
    double thickness = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("center", center, sim::any_number(), {"where it is", "length"});
        option("radius", radius, sim::at_least(0.0), {"of the ball; this or volume", "length"});
        option("volume", volume, sim::at_least(0.0), {"of its gas; this or radius", "length^3"});
        option("velocity", velocity, sim::any_number(), {"at the start, for the solvers that move", "length/time"});
        option("thickness", thickness, sim::at_least(0.0),
               {"of its film at the start, on the mean, for solver melp; 0: material.thickness", "length"});
    }
};

enum class FilmShape {
    kDisk,
    kRectangle,
    kHemisphere,
    kBallInRing,
    kCylinder,
    kCatenoid,
    kFrame,
    kDoubleBubble,
    kTripleBubble,
    kQuadrupleBubble,
    kCube,
    kKelvin,
    kWeairePhelan,
    kMesh
};

/// One [[film]]
struct FilmTable {
    FilmShape shape = FilmShape::kDisk;
    Vec3 center;
    Vec3 axis{{0.0, 0.0, 1.0}};
    double radius = 0.05;
    double separation = 0.04;
    mesh::CatenoidBranch branch = mesh::CatenoidBranch::kStable;
    Vec3 u{{0.1, 0.0, 0.0}};
    Vec3 v{{0.0, 0.1, 0.0}};
    Vec3 focus;
    double focus_radius = 0.0;
    double focus_edge = 0.0;
    mesh::FrameShape frame = mesh::FrameShape::kCube;
    double edge = 0.1;
    double volume = 1e-4;
    double second_volume = 0.0;
    std::string file;
    double scale = 1.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("shape", shape,
               sim::choices<FilmShape>({{"disk", FilmShape::kDisk},
                                        {"rectangle", FilmShape::kRectangle},
                                        {"hemisphere", FilmShape::kHemisphere},
                                        {"ball_in_ring", FilmShape::kBallInRing},
                                        {"cylinder", FilmShape::kCylinder},
                                        {"catenoid", FilmShape::kCatenoid},
                                        {"frame", FilmShape::kFrame},
                                        {"double_bubble", FilmShape::kDoubleBubble},
                                        {"triple_bubble", FilmShape::kTripleBubble},
                                        {"quadruple_bubble", FilmShape::kQuadrupleBubble},
                                        {"cube", FilmShape::kCube},
                                        {"kelvin", FilmShape::kKelvin},
                                        {"weaire_phelan", FilmShape::kWeairePhelan},
                                        {"mesh", FilmShape::kMesh}}),
               {"what it is; ball_in_ring: a bubble that a ring holds at its equator; frame: films from the edges of a"
                " wire frame to its center; cube: a bubble with flat sides; kelvin and weaire_phelan: foams that fill"
                " space; mesh: films from a file"});
        option("center", center, sim::any_number(), {"of the film; of a rectangle, its first corner", "length"});
        option("axis", axis, sim::any_number(), {"normal of a disk, axis of the round shapes"});
        option("radius", radius, sim::more_than(0.0), {"of the ring or rings", "length"});
        option("separation", separation, sim::more_than(0.0), {"of the two rings of a cylinder or catenoid", "length"});
        option("branch", branch,
               sim::choices<mesh::CatenoidBranch>(
                   {{"stable", mesh::CatenoidBranch::kStable}, {"unstable", mesh::CatenoidBranch::kUnstable}}),
               {"of a catenoid: with the wide neck or the narrow one"});
        option("u", u, sim::any_number(), {"first side of a rectangle", "length"});
        option("v", v, sim::any_number(), {"second side of a rectangle, at a right angle", "length"});
        option("focus", focus, sim::any_number(),
               {"point of a rectangle around which its edges are shorter", "length"});
        option("focus_radius", focus_radius, sim::at_least(0.0),
               {"rows and columns so near have focus_edge", "length"});
        option(
            "focus_edge", focus_edge, sim::at_least(0.0),
            {"length of edges there; they grow by a tenth of the distance, up to resolution.edge_length; 0: no focus",
             "length"});
        option("frame", frame,
               sim::choices<mesh::FrameShape>({{"tetrahedron", mesh::FrameShape::kTetrahedron},
                                               {"cube", mesh::FrameShape::kCube},
                                               {"octahedron", mesh::FrameShape::kOctahedron}}),
               {"of a frame: the wire"});
        option("edge", edge, sim::more_than(0.0), {"of the frame's wires, or of the cube", "length"});
        option("volume", volume, sim::more_than(0.0), {"of each bubble; of a double_bubble, its first", "length^3"});
        option("second_volume", second_volume, sim::at_least(0.0),
               {"of the second bubble of a double_bubble; 0: equal", "length^3"});
        option("file", file,
               {"of a mesh: a Surface Evolver datafile (.fe), OBJ or PLY; counts from the scene's folder", "path"});
        option("scale", scale, sim::more_than(0.0), {"of a mesh: meters per unit of length of the file"});
    }
};

enum class FoamSizes { kEqual, kNormal, kLognormal };

/// [foam]: a cluster of bubbles
struct FoamTable {
    int count = 10;
    double volume = 1e-6;
    FoamSizes sizes = FoamSizes::kEqual;
    double deviation = 0.2;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("count", count, sim::between(1, 100'000), {"bubbles"});
        option("volume", volume, sim::more_than(0.0), {"of a bubble, on average", "length^3"});
        option(
            "sizes", sizes,
            sim::choices<FoamSizes>(
                {{"equal", FoamSizes::kEqual}, {"normal", FoamSizes::kNormal}, {"lognormal", FoamSizes::kLognormal}}),
            {"how the bubbles' radii are distributed"});
        option("deviation", deviation, sim::between(0.0, 1.0),
               {"standard deviation of the radii over their mean, for normal and lognormal"});
    }
};

/// One [[tension]]
struct TensionTable {
    int a = 0;
    int b = 1;
    double factor = 1.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("a", a, sim::at_least(0), {"a region; 0 is the outside"});
        option("b", b, sim::at_least(0), {"another"});
        option("factor", factor, sim::more_than(0.0), {"how tense the films between them are, over the material's"});
    }
};

enum class WireShape { kRing, kSegment };

/// One [[wire]]
struct WireTable {
    WireShape shape = WireShape::kRing;
    Vec3 center;
    Vec3 axis{{0.0, 0.0, 1.0}};
    double radius = 0.05;
    Vec3 from{{-0.05, 0.0, 0.0}};
    Vec3 to{{0.05, 0.0, 0.0}};
    double reach = 0.0;
    Vec3 velocity;
    Vec3 spin;
    double start = 0.0;
    double end = 0.0;
    double blow = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("shape", shape, sim::choices<WireShape>({{"ring", WireShape::kRing}, {"segment", WireShape::kSegment}}),
               {"ring: around center; segment: from one point to another. Several make a polyline or a frame"});
        option("center", center, sim::any_number(), {"of a ring", "length"});
        option("axis", axis, sim::any_number(), {"of a ring"});
        option("radius", radius, sim::more_than(0.0), {"of a ring", "length"});
        option("from", from, sim::any_number(), {"first end of a segment", "length"});
        option("to", to, sim::any_number(), {"second end of a segment", "length"});
        option("reach", reach, sim::at_least(0.0),
               {"films this close to the wire are held by it; 0: half an edge", "length"});
        option("velocity", velocity, sim::any_number(), {"of the wire", "length/time"});
        option("spin", spin, sim::any_number(),
               {"angular velocity, about the center of a ring or the middle of a segment", "1/time"});
        option("start", start, sim::at_least(0.0), {"when it begins to move and to blow", "time"});
        option("end", end, sim::at_least(0.0), {"when it stops; 0: never", "time"});
        option("blow", blow, sim::any_number(),
               {"air is blown through a ring along its axis, from start to end: speed of the jet", "length/time"});
    }
};

/// One [[event]]
struct EventTable {
    double time = 0.0;
    int repeat = 1;
    double interval = 0.0;
    film::Event::Kind kind = film::Event::Kind::kPop;
    int region = 1;
    int into = -1;
    double volume = 0.0;
    double factor = 1.0;
    double duration = 0.0;
    Vec3 center;
    double radius = 0.0;
    double spread = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("time", time, sim::at_least(0.0), {"when", "time"});
        option("kind", kind,
               sim::choices<film::Event::Kind>({{"pop", film::Event::Kind::kPop},
                                                {"inflate", film::Event::Kind::kInflate},
                                                {"puncture", film::Event::Kind::kPuncture},
                                                {"spot", film::Event::Kind::kSpot}}),
               {"pop: the film to another region bursts; inflate: a bubble gets another volume; puncture: a film gets a"
                " hole, and spot: one of black film, for solver melp"});
        option("repeat", repeat, sim::between(1, 1'000'000), {"how often it happens"});
        option("interval", interval, sim::at_least(0.0), {"between one time and the next", "time"});
        option("region", region, sim::at_least(0), {"which bubble; 0: pop one at random that touches the outside"});
        option("into", into, sim::at_least(-1),
               {"pop: the region that it joins; -1: the one that shares most film with it"});
        option("volume", volume, sim::at_least(0.0),
               {"inflate: the new volume; 0: `factor` times the first", "length^3"});
        option("factor", factor, sim::more_than(0.0), {"inflate: the new volume over the first"});
        option("duration", duration, sim::at_least(0.0),
               {"inflate: how long it takes, for the solvers that move", "time"});
        option("center", center, sim::any_number(), {"puncture and spot: the nearest film gets it", "length"});
        option("radius", radius, sim::at_least(0.0),
               {"puncture: of the hole; 0: as small as can be resolved; spot: its own", "length"});
        option("spread", spread, sim::at_least(0.0), {"spot: it comes to some film within this of center", "length"});
    }
};

/// One [[vortex]]
struct VortexTable : film::Vortex {
    template <class Visitor>
    void visit(Visitor&& option) {
        option("profile", profile,
               sim::choices<film::Vortex::Profile>({{"gauss", film::Vortex::Profile::kGauss},
                                                    {"taylor", film::Vortex::Profile::kTaylor},
                                                    {"rotation", film::Vortex::Profile::kRotation},
                                                    {"rossby_haurwitz", film::Vortex::Profile::kRossbyHaurwitz},
                                                    {"hole", film::Vortex::Profile::kHole}}),
               {"gauss: of circulation and radius; taylor: of speed at radius, no net circulation; rotation: rigid, of"
                " rate about axis; rossby_haurwitz: the wave l = 4, m = 3 of a sphere; hole: circulation around the"
                " nearest hole of the film"});
        option("center", center, sim::any_number(), {"where it is", "length"});
        option("axis", axis, sim::any_number(), {"of a rotation or rossby_haurwitz"});
        option("radius", radius, sim::at_least(0.0), {"of the core", "length"});
        option("circulation", circulation, sim::any_number(),
               {"counterclockwise seen from the tip of the film's normal", "length^2/time"});
        option("speed", speed, sim::any_number(), {"taylor: the fastest, at radius", "length/time"});
        option("rate", rate, sim::any_number(), {"rotation: angular velocity", "1/time"});
    }
};

/// One [[solid]]
struct SolidTable {
    Vec3 center;
    double radius = 0.0;
    Vec3 velocity;
    Vec3 spin;
    double start = 0.0;
    double end = 0.0;
    double period = 0.0;
    Vec3 stride;
    bool free = false;
    double mass = 0.0;
    Vec3 arm;
    bool wet = true;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("center", center, sim::any_number(), {"where it is at first", "length"});
        option("radius", radius, sim::at_least(0.0), {"of the ball or stick", "length"});
        option("velocity", velocity, sim::any_number(), {"of it; of a free one at the start", "length/time"});
        option("spin", spin, sim::any_number(), {"angular velocity, likewise", "1/time"});
        option("start", start, sim::at_least(0.0), {"when it begins to move", "time"});
        option("end", end, sim::at_least(0.0), {"when it stops; 0: never", "time"});
        option(
            "period", period, sim::at_least(0.0),
            {"it moves from start to end of each period and is out of the film between, as a leg that steps; 0: once",
             "time"});
        option("stride", stride, sim::any_number(), {"how much farther it begins each period", "length"});
        option("free", free, {"true: what the film does to it moves it"});
        option("mass", mass, sim::at_least(0.0), {"of a free one, beyond that of the film that it covers", "mass"});
        option("arm", arm, sim::any_number(),
               {"of a stick with round ends: from its middle to the center of an end; 0: a ball", "length"});
        option("wet", wet, {"true: films slide on it; false: they burst where it touches them"});
    }
};

/// One [[wall]]
struct WallTable {
    Vec3 point;
    Vec3 normal{{0.0, 0.0, 1.0}};
    bool bursts = false;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("point", point, sim::any_number(), {"of the plane", "length"});
        option("normal", normal, sim::any_number(), {"toward the side where the bubbles are"});
        option("bursts", bursts, {"true: bubbles that touch it burst; false: they rest on it, dry"});
    }
};

/// One [[faucet]]
struct FaucetTable {
    Vec3 center;
    Vec3 velocity;
    double width = 0.0;
    int count = 1;
    double radius = 0.0;
    double radius_spread = 0.0;
    double start = 0.0;
    double interval = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("center", center, sim::any_number(), {"where its bubbles enter", "length"});
        option("velocity", velocity, sim::any_number(), {"with which they do", "length/time"});
        option("width", width, sim::at_least(0.0),
               {"they enter at random in a disk of this radius across velocity", "length"});
        option("count", count, sim::between(1, 100'000), {"how many"});
        option("radius", radius, sim::at_least(0.0), {"of the bubbles, on average", "length"});
        option("radius_spread", radius_spread, sim::between(0.0, 0.5),
               {"they are evenly distributed so far below and above that, over it"});
        option("start", start, sim::at_least(0.0), {"when the first enters", "time"});
        option("interval", interval, sim::at_least(0.0),
               {"between one and the next; each waits until its place is free", "time"});
    }
};

/// All of them, as read.
struct FilmTables {
    MaterialTable material;
    ResolutionTable resolution;
    std::vector<BubbleTable> bubbles;
    std::vector<FilmTable> films;
    std::vector<FoamTable> foams;  ///< none or one
    std::vector<TensionTable> tensions;
    std::vector<WireTable> wires;
    std::vector<EventTable> events;
    std::vector<VortexTable> vortices;
    std::vector<SolidTable> solids;
    std::vector<WallTable> walls;
    std::vector<FaucetTable> faucets;
};

/// Their names, and how each is described: "[[bubble]]" may be there several times, "[foam]" once.
struct FilmTableInfo {
    std::string name;
    std::string summary;
    bool list;
    std::vector<sim::OptionInfo> options;
};
std::vector<FilmTableInfo> film_table_infos();

/// @param root  the whole scene  @throws InputError  file:line, key, what was found and what is allowed
FilmTables read_film_tables(const sim::Node& root);

/// The films that they describe. @throws InputError  naming the table at fault
film::Problem film_problem(const FilmTables& tables, const sim::Node& root, std::uint64_t seed);

/// As TOML, every default filled in.
std::string film_tables_toml(const FilmTables& tables, double edge_length);

}  // namespace lamella::scene
