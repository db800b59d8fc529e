#include "lamella/scene/film_tables.h"

#include "lamella/core/error.h"
#include "lamella/core/random.h"
#include "lamella/mesh/check.h"
#include "lamella/mesh/join.h"
#include "lamella/mesh/shapes/cube.h"
#include "lamella/mesh/shapes/periodic_foam.h"
#include "lamella/mesh/shapes/power_cluster.h"
#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/scene/detail/attach_wires.h"
#include "lamella/scene/detail/film_from_file.h"
#include "lamella/scene/detail/obstacles.h"
#include "lamella/scene/detail/releases.h"
#include "lamella/scene/detail/table_place.h"
#include "lamella/scene/detail/toml_writer.h"
#include "lamella/sim/read_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace lamella::scene {
namespace {

using detail::at_table;
using detail::place;
using mesh::FoamMesh;
using mesh::RegionKind;

constexpr double kPi = 3.14159265358979323846;
const sim::ModelUnits kSi{.length = "m", .mass = "kg", .time = "s"};

template <class Table>
std::vector<Table> read_list(const sim::Node& root, std::string_view name) {
    std::vector<Table> tables;
    const sim::Node* node = root.find(name);
    if (node == nullptr || (name == "bubble" && node->table() != nullptr)) return tables;  // [bubble]: of that solver
    const auto* items = node->array();
    if (items == nullptr)
        throw InputError(node->where, fmt::format("{} must be a list of tables: write [[{}]]", name, name));
    for (const sim::Node& item : *items) tables.push_back(sim::read_options<Table>(item, kSi));
    return tables;
}

template <class Table>
Table read_one(const sim::Node& root, std::string_view name) {
    const sim::Node* node = root.find(name);
    return node != nullptr ? sim::read_options<Table>(*node, kSi) : Table{};
}

mesh::Ball ball_of(const BubbleTable& bubble, const SourceLocation& where) {
    if ((bubble.radius > 0.0) == (bubble.volume > 0.0))
        throw InputError(where, "a bubble needs either its radius or its volume, e.g. radius = \"5 cm\"");
    return {bubble.center, bubble.radius > 0.0 ? bubble.radius : std::cbrt(0.75 * bubble.volume / kPi)};
}

std::vector<double> foam_radii(const FoamTable& foam, std::uint64_t seed) {
    const double mean = std::cbrt(0.75 * foam.volume / kPi);
    std::vector<double> radii;
    for (int k = 0; k < foam.count; ++k) {
        const auto bits = random_bits(seed, RandomStream::kFoamSizes, 0, static_cast<std::uint64_t>(k));
        const double z = normal(bits);
        double radius = mean;
        if (foam.sizes == FoamSizes::kNormal) radius = mean * std::clamp(1.0 + foam.deviation * z, 0.2, 3.0);
        if (foam.sizes == FoamSizes::kLognormal) {
            const double s = std::sqrt(std::log1p(foam.deviation * foam.deviation));
            radius = mean * std::clamp(std::exp(s * z - 0.5 * s * s), 0.2, 3.0);
        }
        radii.push_back(radius);
    }
    return radii;
}

bool any_touch(const std::vector<mesh::Ball>& balls) {
    for (std::size_t i = 0; i < balls.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (norm(balls[i].center - balls[j].center) <= balls[i].radius + balls[j].radius) return true;
    return false;
}

/// Balls that touch become a cluster. Targets are the volumes of the balls.
FoamMesh bubbles_of(const std::vector<mesh::Ball>& balls, double edge_length) {
    if (!any_touch(balls)) return mesh::spheres(balls, edge_length);
    FoamMesh cluster = mesh::power_cluster(balls, edge_length);
    for (std::size_t k = 0; k < balls.size(); ++k)
        cluster.regions[static_cast<mesh::RegionId>(k + 1)].target_volume =
            4.0 / 3.0 * kPi * std::pow(balls[k].radius, 3);
    return cluster;
}

FoamMesh film_of(const FilmTable& film, double h) {
    if (film.focus_edge > 0.0 && film.shape != FilmShape::kRectangle)
        throw InputError("film.focus_edge is for shape = \"rectangle\"");
    switch (film.shape) {
        case FilmShape::kDisk:
            return mesh::disk(film.center, film.axis, film.radius, h);
        case FilmShape::kRectangle:
            if (film.focus_edge == 0.0) return mesh::rectangle(film.center, film.u, film.v, h);
            return mesh::rectangle(film.center, film.u, film.v, h, {film.focus, film.focus_radius, film.focus_edge});
        case FilmShape::kHemisphere:
            return mesh::hemisphere(film.center, film.axis, film.radius, h);
        case FilmShape::kBallInRing:
            return mesh::ball_in_ring(film.center, film.axis, film.radius, h);
        case FilmShape::kCylinder:
            return mesh::cylinder(film.center, film.axis, film.radius, film.separation, h);
        case FilmShape::kCatenoid:
            return mesh::catenoid(film.center, film.axis, film.radius, film.separation, h, film.branch);
        case FilmShape::kFrame:
            return mesh::frame_cone(film.frame, film.center, film.edge, h);
        case FilmShape::kDoubleBubble: {
            const double second = film.second_volume > 0.0 ? film.second_volume : film.volume;
            FoamMesh bubbles = mesh::double_bubble(mesh::double_bubble_of_volumes(film.volume, second), h);
            for (Vec3& x : bubbles.position) x += film.center;
            return bubbles;
        }
        case FilmShape::kTripleBubble:
            return mesh::triple_bubble(film.volume, h);
        case FilmShape::kQuadrupleBubble:
            return mesh::quadruple_bubble(film.volume, h);
        case FilmShape::kCube:
            return mesh::cube_bubble(film.center, film.edge, h);
        case FilmShape::kKelvin:
            return mesh::periodic_foam(mesh::PeriodicFoam::kKelvin, film.volume, h);
        case FilmShape::kWeairePhelan:
            return mesh::periodic_foam(mesh::PeriodicFoam::kWeairePhelan, film.volume, h);
        case FilmShape::kMesh:
            break;  // read before the edge length is known: films_of_files
    }
    return {};
}

/// What the edge length is taken from when the scene says none.
double film_size(const FilmTable& film) {
    switch (film.shape) {
        case FilmShape::kDisk:
        case FilmShape::kHemisphere:
        case FilmShape::kBallInRing:
        case FilmShape::kCylinder:
        case FilmShape::kCatenoid:
            return 2.0 * film.radius;
        case FilmShape::kRectangle:
            return std::min(norm(film.u), norm(film.v));
        case FilmShape::kFrame:
        case FilmShape::kCube:
            return 1.5 * film.edge;
        default:
            return std::cbrt(film.second_volume > 0.0 ? std::min(film.volume, film.second_volume) : film.volume) * 3.0;
    }
}

/// What the files of [[film]] hold; empty for films of known shapes.
std::vector<io::FilmFile> films_of_files(const FilmTables& tables, const sim::Node& root) {
    std::vector<io::FilmFile> files(tables.films.size());
    const std::filesystem::path folder = std::filesystem::path(root.where.file).parent_path();
    for (std::size_t k = 0; k < files.size(); ++k) {
        const FilmTable& film = tables.films[k];
        const bool mesh = film.shape == FilmShape::kMesh;
        if (mesh == film.file.empty())
            throw InputError(place(root, "film", k), mesh ? "film: shape = \"mesh\" needs file = \"...\""
                                                          : "film.file goes with shape = \"mesh\" only");
        if (mesh)
            files[k] = at_table(place(root, "film", k), "film",
                                [&] { return detail::scaled_films(folder / film.file, film.scale, film.center); });
    }
    return files;
}

double default_edge_length(const FilmTables& tables,
                           const std::vector<mesh::Ball>& balls,
                           const std::vector<io::FilmFile>& files) {
    double edge = 0.0;
    const auto at_most = [&](double length) { edge = edge == 0.0 ? length : std::min(edge, length); };
    for (const mesh::Ball& ball : balls) at_most(0.25 * ball.radius);
    for (std::size_t k = 0; k < files.size(); ++k)
        at_most(tables.films[k].shape == FilmShape::kMesh ? detail::edge_length_for(files[k].mesh)
                                                          : 0.05 * film_size(tables.films[k]));
    return edge;
}

film::Event event_of(const EventTable& event, const FoamMesh& mesh, const SourceLocation& where) {
    const auto kind_of = [&](int region) {
        const bool there = region >= 0 && static_cast<std::size_t>(region) < mesh.regions.size();
        return there ? mesh.regions[static_cast<mesh::RegionId>(region)].kind : RegionKind::kGone;
    };
    const bool random = event.region == 0 && event.kind == film::Event::Kind::kPop;
    if (event.repeat > 1 && !(event.interval > 0.0))
        throw InputError(where, "event.interval = 0 puts all repetitions at one time; say how far apart they are");
    if (event.kind == film::Event::Kind::kPuncture)
        return {.kind = event.kind, .time = event.time, .center = event.center, .radius = event.radius};
    if (event.kind == film::Event::Kind::kSpot) {
        if (!(event.radius > 0.0)) throw InputError(where, "event.radius is missing: of the spot, e.g. \"5 mm\"");
        return {.kind = event.kind,
                .time = event.time,
                .center = event.center,
                .radius = event.radius,
                .spread = event.spread};
    }
    if (!random && kind_of(event.region) != RegionKind::kClosed)
        throw InputError(where, fmt::format("event.region = {} is no bubble; there are {} regions beside the outside",
                                            event.region, mesh.regions.size() - 1));
    if (event.into >= 0 && (kind_of(event.into) == RegionKind::kGone || (!random && event.into == event.region)))
        throw InputError(
            where, fmt::format("event.into = {} is no region that bubble {} could join", event.into, event.region));
    const auto region = random ? film::kRandomBubble : static_cast<mesh::RegionId>(event.region);
    const double first = random ? 0.0 : mesh.regions[region].target_volume;
    return {.kind = event.kind,
            .time = event.time,
            .region = region,
            .into = event.into < 0 ? film::kLargestNeighbor : static_cast<mesh::RegionId>(event.into),
            .volume = event.volume > 0.0 ? event.volume : event.factor * first,
            .duration = event.duration};
}

std::vector<film::Event> events_of(const FilmTables& tables, const FoamMesh& mesh, const sim::Node& root) {
    std::vector<film::Event> events;
    for (std::size_t k = 0; k < tables.events.size(); ++k) {
        film::Event event = event_of(tables.events[k], mesh, place(root, "event", k));
        for (int n = 0; n < tables.events[k].repeat; ++n) {
            event.time = tables.events[k].time + n * tables.events[k].interval;
            events.push_back(event);
        }
    }
    std::stable_sort(events.begin(), events.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    return events;
}

film::Vortex vortex_of(const VortexTable& vortex, const SourceLocation& where) {
    using Profile = film::Vortex::Profile;
    const bool core = vortex.profile == Profile::kGauss || vortex.profile == Profile::kTaylor;
    if (core && !(vortex.radius > 0.0)) throw InputError(where, "vortex.radius is missing: of its core, e.g. \"3 cm\"");
    if (!core && norm(vortex.axis) == 0.0) throw InputError(where, "vortex.axis = [0, 0, 0] is no direction");
    film::Vortex ready = vortex;
    if (!core) ready.axis = vortex.axis / norm(vortex.axis);
    return ready;
}

/// The velocity that the scene gives to each of its bubbles; films and foams have none.
IdVector<mesh::RegionId, Vec3> start_velocities(const FilmTables& tables, const FoamMesh& mesh) {
    IdVector<mesh::RegionId, Vec3> velocity(mesh.regions.size());
    for (std::size_t k = 0; k < tables.bubbles.size(); ++k)  // bubbles are joined first: k is region k + 1
        velocity[static_cast<mesh::RegionId>(k + 1)] = tables.bubbles[k].velocity;
    return velocity;
}

/// Likewise of their films' thickness.
IdVector<mesh::RegionId, double> start_thickness(const FilmTables& tables, const FoamMesh& mesh) {
    IdVector<mesh::RegionId, double> thickness(mesh.regions.size());
    for (std::size_t k = 0; k < tables.bubbles.size(); ++k)
        thickness[static_cast<mesh::RegionId>(k + 1)] = tables.bubbles[k].thickness;
    return thickness;
}

/// Those of films that are about to be added: their regions will follow those that are there.
void add_tensions(film::Problem& problem, const std::vector<io::PairTension>& tensions) {
    const std::size_t before = problem.mesh.regions.size() - 1;
    const auto moved = [&](mesh::RegionId r) {
        return r == mesh::kOutside ? r : static_cast<mesh::RegionId>(index(r) + before);
    };
    for (const io::PairTension& t : tensions) problem.tensions.push_back({moved(t.a), moved(t.b), t.factor});
}

template <class Table>
FilmTableInfo info_of(std::string name, std::string summary, bool list) {
    return {std::move(name), std::move(summary), list, sim::describe_options<Table>()};
}

template <class Table>
std::string toml_of(const std::string& name, const Table& table, bool list) {
    const sim::Node node = sim::resolve_options(table);
    const std::string text = detail::toml_text(name, node, [](std::string_view) { return std::string(); });
    return (list ? "[" + text.substr(0, text.find('\n')) + "]" + text.substr(text.find('\n')) : text) + "\n";
}

}  // namespace

std::vector<FilmTableInfo> film_table_infos() {
    return {info_of<MaterialTable>("material", "the soap solution and the air around it", false),
            info_of<ResolutionTable>("resolution", "how fine the films are", false),
            info_of<BubbleTable>("bubble", "one bubble: [[bubble]]; those that touch become a cluster", true),
            info_of<FilmTable>("film", "one film or cluster of a known shape: [[film]]", true),
            info_of<FoamTable>("foam", "a cluster of bubbles in random places", false),
            info_of<TensionTable>("tension", "films that are tenser than others: [[tension]]", true),
            info_of<WireTable>("wire", "a wire that holds films, at rest or moving: [[wire]]", true),
            info_of<EventTable>("event", "what happens to bubbles on the way: [[event]]", true),
            info_of<VortexTable>("vortex", "what swirls in the film at the start: [[vortex]]", true),
            info_of<SolidTable>("solid", "a ball or stick in the film: [[solid]]", true),
            info_of<WallTable>("wall", "a plane that bubbles rest on: [[wall]]", true),
            info_of<FaucetTable>("faucet", "bubbles that enter on the way: [[faucet]]", true)};
}

FilmTables read_film_tables(const sim::Node& root) {
    FilmTables tables{.material = read_one<MaterialTable>(root, "material"),
                      .resolution = read_one<ResolutionTable>(root, "resolution"),
                      .bubbles = read_list<BubbleTable>(root, "bubble"),
                      .films = read_list<FilmTable>(root, "film"),
                      .foams = {},
                      .tensions = read_list<TensionTable>(root, "tension"),
                      .wires = read_list<WireTable>(root, "wire"),
                      .events = read_list<EventTable>(root, "event"),
                      .vortices = read_list<VortexTable>(root, "vortex"),
                      .solids = read_list<SolidTable>(root, "solid"),
                      .walls = read_list<WallTable>(root, "wall"),
                      .faucets = read_list<FaucetTable>(root, "faucet")};
    if (root.find("foam") != nullptr) tables.foams.push_back(read_one<FoamTable>(root, "foam"));
    return tables;
}

film::Problem film_problem(const FilmTables& tables, const sim::Node& root, std::uint64_t seed) {
    std::vector<mesh::Ball> balls;
    for (std::size_t k = 0; k < tables.bubbles.size(); ++k)
        balls.push_back(ball_of(tables.bubbles[k], place(root, "bubble", k)));
    if (balls.empty() && tables.films.empty() && tables.foams.empty() && tables.faucets.empty())
        throw InputError({root.where.file, 0, 0},
                         "the scene has no films; add a [[bubble]] with center and radius, a [[film]], or [foam]");
    std::vector<mesh::Ball> cluster;
    if (!tables.foams.empty())
        cluster = at_table(place(root, "foam", 0), "foam",
                           [&] { return mesh::pack_balls(foam_radii(tables.foams[0], seed), seed); });

    film::Problem problem;
    problem.material = tables.material;
    std::vector<mesh::Ball> all = balls;
    all.insert(all.end(), cluster.begin(), cluster.end());
    for (const FaucetTable& faucet : tables.faucets) all.push_back({faucet.center, faucet.radius});
    std::vector<io::FilmFile> files = films_of_files(tables, root);
    problem.edge_length =
        tables.resolution.edge_length > 0.0 ? tables.resolution.edge_length : default_edge_length(tables, all, files);
    const double h = problem.edge_length;
    problem.mesh.regions.push_back({RegionKind::kOpen, 0.0});
    const auto add = [&](FoamMesh part) {
        if (problem.mesh.faces.empty())
            problem.mesh = std::move(part);
        else
            mesh::join(problem.mesh, part);
    };
    if (!balls.empty()) at_table(place(root, "bubble", 0), "bubble", [&] { add(bubbles_of(balls, h)); });
    for (std::size_t k = 0; k < tables.films.size(); ++k)
        at_table(place(root, "film", k), "film", [&] {
            if (tables.films[k].shape != FilmShape::kMesh) return add(film_of(tables.films[k], h));
            detail::refine_films(files[k].mesh, h);
            add_tensions(problem, files[k].tensions);
            add(std::move(files[k].mesh));
        });
    if (!cluster.empty()) at_table(place(root, "foam", 0), "foam", [&] { add(bubbles_of(cluster, h)); });
    detail::attach_wires(problem, tables, root);
    if (!problem.mesh.faces.empty())
        mesh::require_sound(problem.mesh, root.where.file.empty() ? "the films" : root.where.file);
    detail::add_releases(problem, tables, root, seed);
    problem.velocity = start_velocities(tables, problem.mesh);
    problem.thickness = start_thickness(tables, problem.mesh);

    for (std::size_t k = 0; k < tables.tensions.size(); ++k) {
        const TensionTable& t = tables.tensions[k];
        if (static_cast<std::size_t>(std::max(t.a, t.b)) >= problem.mesh.regions.size() || t.a == t.b)
            throw InputError(place(root, "tension", k),
                             fmt::format("tension.a = {} and b = {} are no two regions of this scene", t.a, t.b));
        problem.tensions.push_back({static_cast<mesh::RegionId>(t.a), static_cast<mesh::RegionId>(t.b), t.factor});
    }
    problem.events = events_of(tables, problem.mesh, root);
    for (std::size_t k = 0; k < tables.vortices.size(); ++k)
        problem.vortices.push_back(vortex_of(tables.vortices[k], place(root, "vortex", k)));
    for (std::size_t k = 0; k < tables.solids.size(); ++k)
        problem.solids.push_back(detail::solid_of(tables.solids[k], place(root, "solid", k)));
    for (std::size_t k = 0; k < tables.walls.size(); ++k)
        problem.walls.push_back(detail::wall_of(tables.walls[k], place(root, "wall", k)));
    return problem;
}

std::string film_tables_toml(const FilmTables& tables, double edge_length) {
    std::string text = toml_of("material", tables.material, false);
    ResolutionTable resolution = tables.resolution;
    resolution.edge_length = edge_length;
    text += toml_of("resolution", resolution, false);
    for (const BubbleTable& bubble : tables.bubbles) text += toml_of("bubble", bubble, true);
    for (const FilmTable& film : tables.films) text += toml_of("film", film, true);
    for (const FoamTable& foam : tables.foams) text += toml_of("foam", foam, false);
    for (const TensionTable& tension : tables.tensions) text += toml_of("tension", tension, true);
    for (const WireTable& wire : tables.wires) text += toml_of("wire", wire, true);
    for (const EventTable& event : tables.events) text += toml_of("event", event, true);
    for (const VortexTable& vortex : tables.vortices) text += toml_of("vortex", vortex, true);
    for (const SolidTable& solid : tables.solids) text += toml_of("solid", solid, true);
    for (const WallTable& wall : tables.walls) text += toml_of("wall", wall, true);
    for (const FaucetTable& faucet : tables.faucets) text += toml_of("faucet", faucet, true);
    return text;
}

}  // namespace lamella::scene
