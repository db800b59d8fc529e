// What of a scene the solver does not know, refused by name.

#include "lamella/solvers/melp/refusals.h"

#include "lamella/core/error.h"
#include "lamella/film/surfactant.h"
#include "lamella/solvers/melp/bubble_shapes.h"
#include "lamella/solvers/melp/open_films.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace lamella::melp {
namespace {

/// Where bubbles meet, films fold within a few spacings: folds have to fit onto the bubble.
void refuse_coarse_contacts(const film::Problem& films) {
    const auto& regions = films.mesh.regions;
    const auto bubbles = films.bubble_count();
    if (bubbles < 2) return;
    constexpr double kFinest = 6.0;
    for (const mesh::RegionId r : regions.ids()) {
        const double radius = std::cbrt(0.75 * regions[r].target_volume / std::numbers::pi);
        if (regions[r].kind == mesh::RegionKind::kClosed && films.edge_length > 1.001 * radius / kFinest)
            throw InputError(
                fmt::format("resolution.edge_length = {:.4g} m is too coarse for bubble {} among others: at most a "
                            "sixth of its radius of {:.4g} m will do",
                            films.edge_length, index(r), radius));
    }
}

/// How far bubbles, those of faucets too, reach behind a wall, and which one does farthest; below 0: none. [m]
std::pair<double, mesh::RegionId> deepest_behind(const film::Wall& wall,
                                                 const film::Problem& films,
                                                 const IdVector<mesh::RegionId, std::optional<mesh::Ball>>& loose) {
    std::pair<double, mesh::RegionId> deepest{-1.0, mesh::kOutside};
    const auto reach = [&](mesh::RegionId bubble, const Vec3& center, double radius) {
        deepest = std::max(deepest, {dot(wall.point - center, wall.normal) + radius, bubble});
    };
    const auto& regions = films.mesh.regions;
    for (const film::Release& release : films.releases) reach(release.region, release.center, release.radius);
    for (const mesh::RegionId r : regions.ids())
        if (loose[r]) reach(r, loose[r]->center, loose[r]->radius);
    for (const mesh::Face& face : films.mesh.faces)
        for (const mesh::RegionId r : {face.back, face.front})
            if (regions[r].kind == mesh::RegionKind::kClosed && !loose[r])
                for (const mesh::VertexId v : face.vertices) reach(r, films.mesh.position[v], 0.0);
    return deepest;
}

/// A wall throws out what starts behind it: bubbles may touch it at most.
void refuse_bubbles_behind_walls(const film::Problem& films) {
    constexpr double kTouching = 1e-3;  // of the bubble's size
    const IdVector<mesh::RegionId, std::optional<mesh::Ball>> loose = loose_balls(films.mesh);
    for (std::size_t k = 0; k < films.walls.size(); ++k) {
        const auto [depth, bubble] = deepest_behind(films.walls[k], films, loose);
        if (depth > 0.0 && depth > kTouching * std::cbrt(films.mesh.regions[bubble].target_volume))
            throw InputError(
                fmt::format("bubble {} starts {:.3g} m behind [[wall]] {}: bubbles and faucets belong wholly on the "
                            "side that wall.normal points to",
                            index(bubble), depth, k + 1));
    }
}

/// Films slide on wet solids, burst on dry ones, and pull free balls.
void refuse_unknown_solids(const film::Problem& films, const Options& options) {
    constexpr double kSmallest = 3.0;  // spacings
    for (const film::Solid& solid : films.solids) {
        if (solid.wet && (films.bubble_count() > 0 || options.rim != RimHold::kWire))
            throw InputError("melp: wet [[solid]]s are built for films on wires only; bubbles burst on wet = false");
        if (solid.wet && solid.radius < 0.999 * kSmallest * films.edge_length)
            throw InputError(
                fmt::format("solid.radius = {:.4g} m is too small for resolution.edge_length = {:.4g} m: "
                            "three of these at least will do",
                            solid.radius, films.edge_length));
        if (norm(solid.spin) > 0.0)
            throw InputError("melp: solid.spin would do nothing: films slide on solids; use solver vortex_particle");
        if (solid.free && (norm(solid.arm) > 0.0 || !solid.wet))
            throw InputError("melp: solid.free is built for wet balls only");
        if (solid.free && !(solid.mass > 0.0))
            throw InputError("melp: solid.mass is missing: of the free ball, e.g. \"50 mg\"");
        if (!solid.wet && options.fine_ratio == 0 && films.bubble_count() < 2)
            throw InputError(
                "melp.fine_ratio = 0: films burst only with fine particles, whose liquid the edge gathers");
    }
}

/// Warm films are less tense: some tension has to be left.
void refuse_unknown_heat(const film::Material& material, const Options& options) {
    const HeatOptions& heat = options.heat;
    if (heat.source == HeatSource::kNone) return;
    if (options.fine_ratio == 0) throw InputError("melp.fine_ratio = 0: heat is carried by fine particles only");
    if (!(heat.temperature > 0.0)) throw InputError("melp.heat.temperature is missing: of the source, e.g. 320");
    if (!(heat.reach > 0.0)) throw InputError("melp.heat.reach is missing: of the source, e.g. \"5 cm\"");
    const double more = heat.temperature - material.temperature;
    const double pressed =
        film::kGasConstant * film::start_surfactant(material) * (2.0 * heat.temperature) - film::elasticity(material);
    const double left = material.surface_tension + heat.tension_slope * more - std::max(pressed, 0.0);
    if (!(left > 0.0))
        throw InputError(
            fmt::format("melp.heat.temperature = {:.4g} K leaves films with twice the surfactant no tension: "
                        "{:.3g} N/m",
                        heat.temperature, left));
}

void refuse_unknown_spots(const film::Problem& films, const Options& options) {
    std::vector<std::pair<const char*, double>> radii;
    if (options.start.spots > 0) radii.push_back({"melp.start.spot_radius", options.start.spot_radius});
    for (const film::Event& event : films.events)
        if (event.kind == film::Event::Kind::kSpot) radii.push_back({"melp: [[event]] spot: radius", event.radius});
    if (options.fine_ratio == 0 && (!radii.empty() || options.black_film.thickness > 0.0))
        throw InputError("melp.fine_ratio = 0: black films are where fine particles have little liquid");
    for (const auto& [name, radius] : radii)
        if (radius < 2.0 * films.edge_length)
            throw InputError(fmt::format(
                "{} = {:.4g} m is too small for resolution.edge_length = {:.4g} m: twice of it at least will do", name,
                radius, films.edge_length));
}

}  // namespace

void refuse_unknown_films(const film::Problem& films, const Options& options) {
    const mesh::FoamMesh& mesh = films.mesh;
    if (mesh.periodic()) throw InputError("melp: films in a periodic box are for solver equilibrium");
    const auto kind = [&](mesh::RegionId r) { return mesh.regions[r].kind; };
    IdVector<mesh::VertexId, std::uint8_t> of_bubble(mesh.position.size());
    for (const mesh::Face& face : mesh.faces) {
        const bool back = kind(face.back) == mesh::RegionKind::kClosed,
                   front = kind(face.front) == mesh::RegionKind::kClosed;
        if (back || front)
            for (const mesh::VertexId v : face.vertices) of_bubble[v] = 1;
        if ((back && !front && face.front != mesh::kOutside) || (front && !back && face.back != mesh::kOutside))
            throw InputError("melp: bubbles in films on wires are not built yet; use solver vortex_sheet");
    }
    for (const mesh::VertexId v : mesh.position.ids())
        if (mesh.on_wire[v] != 0 && of_bubble[v] != 0)
            throw InputError("melp: wires that hold closed bubbles are not built yet; use solver vortex_sheet");
    for (const film::Wire& wire : films.wires)
        if (wire.ring && wire.ring->blow != 0.0)
            throw InputError("melp: wire.blow is not built yet; use solver vortex_sheet");
    for (const OpenFilm& film : open_films(films))
        if (options.rim != RimHold::kWire && !film.half_sphere())
            throw InputError("melp.rim: a plate under films is built for [[film]] with shape = \"hemisphere\" only");
        else if (options.start.mode_amplitude != 0.0 && options.rim != RimHold::kWetPlate)
            throw InputError("melp.start.mode_amplitude: films that are held by wires start at rest");
    refuse_unknown_heat(films.material, options);
    refuse_unknown_spots(films, options);
    if (options.black_film.line_tension > 0.0 && options.black_film.thickness == 0.0)
        throw InputError("melp.black_film.line_tension needs black_film.thickness, e.g. \"100 nm\"");
    if (options.exchange_rate > 0.0 && options.fine_ratio == 0)
        throw InputError("melp.fine_ratio = 0: films exchange liquid only where it is on fine particles");
    if (!films.tensions.empty()) throw InputError("melp: [[tension]] is not built yet; use solver equilibrium");
    refuse_unknown_solids(films, options);
    if (!films.vortices.empty()) throw InputError("melp: [[vortex]] is not built yet; use solver vortex_particle");
    for (const film::Event& event : films.events) {
        if (event.kind == film::Event::Kind::kSpot) continue;
        if (event.kind == film::Event::Kind::kInflate)
            throw InputError("melp: [[event]] with kind = \"inflate\" is not built yet; use solver vortex_sheet");
        const bool foam = films.bubble_count() > 1;
        if (foam && event.kind == film::Event::Kind::kPuncture)
            throw InputError("melp: [[event]] puncture in scenes of several bubbles is not built yet; use pop");
        if (!foam && (event.region == film::kRandomBubble || event.into != film::kLargestNeighbor))
            throw InputError("melp: [[event]] pop of a bubble on its own takes a region and no `into`");
        if (!foam && options.fine_ratio == 0)
            throw InputError(
                "melp.fine_ratio = 0: films burst only with fine particles, whose liquid the edge gathers");
    }
    refuse_coarse_contacts(films);
    refuse_bubbles_behind_walls(films);
}

}  // namespace lamella::melp
