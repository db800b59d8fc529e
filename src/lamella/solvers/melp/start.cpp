#include "lamella/solvers/melp/start.h"

#include "lamella/core/error.h"
#include "lamella/film/surfactant.h"
#include "lamella/mesh/volume.h"
#include "lamella/solvers/melp/bubble_shapes.h"
#include "lamella/solvers/melp/open_films.h"
#include "lamella/solvers/melp/refusals.h"
#include "lamella/solvers/melp/solids.h"
#include "lamella/solvers/melp/start_thickness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace lamella::melp {
namespace {

using mesh::Ball;
using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;

Sample on_ball(const Ball& ball, std::size_t count) {
    Sample sample{{}, fibonacci_sphere(count)};
    for (const Vec3& n : sample.normal) sample.position.push_back(ball.center + ball.radius * n);
    return sample;
}

double legendre(int degree, double c) {
    double before = 1.0, now = c;
    if (degree == 0) return 1.0;
    for (int l = 2; l <= degree; ++l) {
        const double next = ((2 * l - 1) * c * now - (l - 1) * before) / l;
        before = now;
        now = next;
    }
    return now;
}

/// Radial displacement by a mode about the x axis. Normals are those of the round bubble; the first fit corrects them.
void deform(std::vector<Vec3>& position, const Vec3& center, const StartOptions& options) {
    if (options.mode_amplitude == 0.0) return;
    for (Vec3& x : position) {
        const Vec3 arm = x - center;
        x = center + (1.0 + options.mode_amplitude * legendre(options.mode, arm[0] / norm(arm))) * arm;
    }
}

}  // namespace

std::vector<Vec3> fibonacci_sphere(std::size_t count) {
    std::vector<Vec3> points;
    points.reserve(count);
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
        const double r = std::sqrt(1.0 - z * z), angle = golden_angle * static_cast<double>(i);
        points.push_back({{r * std::cos(angle), r * std::sin(angle), z}});
    }
    return points;
}

namespace {

/// What the films of one region start from.
struct RegionStart {
    Sample coarse{}, fine{};
    double area = 0.0, volume = 0.0;  ///< volume 0: no gas
    double thickness = 0.0;           ///< 0: material.thickness [m]
    Vec3 velocity{};
    std::optional<Vec3> center{};  ///< of modes and noise; nothing: the mean of its particles
    bool held = false;
};

void append(Start& start,
            RegionStart region,
            std::int32_t number,
            double target_volume,
            const film::Material& material,
            const Options& options,
            StartThickness& thickness) {
    const auto here = static_cast<std::int32_t>(start.gas.size());
    Vec3 center;
    for (const Vec3& x : region.coarse.position) center += x / static_cast<double>(region.coarse.position.size());
    center = region.center.value_or(center);
    const double share = region.area / static_cast<double>(std::max(region.fine.position.size(), std::size_t{1}));
    thickness.begin(region.fine.position, region.thickness);
    for (const Vec3& x : region.fine.position) {
        const double whole = thickness.at(x, x - center);
        const double soap = options.start.surfactant == StartSurfactant::kUniform ? 1.0 : whole;
        const double thick = thickness.in_spot(x) ? options.start.spot_thickness / material.thickness : whole;
        start.fine.liquid_volume.push_back(thick * material.thickness * share);
        start.fine.surfactant.push_back(soap * film::start_surfactant(material) * share);
        start.fine.thickness.push_back(thick * material.thickness);
    }
    deform(region.coarse.position, center, options.start);
    deform(region.fine.position, center, options.start);

    const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    add(start.coarse.position, region.coarse.position);
    add(start.coarse.frame_normal, region.coarse.normal);
    start.coarse.velocity.resize(start.coarse.position.size(), region.velocity);
    start.coarse.region.resize(start.coarse.position.size(), here);
    add(start.fine.position, region.fine.position);
    add(start.fine.normal, region.fine.normal);
    start.fine.velocity.resize(start.fine.position.size(), region.velocity);
    start.fine.gradient.resize(start.fine.position.size());
    start.fine.temperature.resize(start.fine.position.size(), material.temperature);
    start.fine.region.resize(start.fine.position.size(), here);

    Gas gas{.region = number,
            .volume = region.volume,
            .closed = region.volume > 0.0,
            .held = region.held,
            .cell = region.area / static_cast<double>(std::max(region.coarse.position.size(), std::size_t{1})),
            .film_radius = std::sqrt(region.area / std::numbers::pi)};
    if (gas.closed) {
        const double gauge = 2.0 / 3.0 * material.film_tension() * region.area / region.volume;
        gas.amount = (options.outside_pressure + gauge) * target_volume;
        gas.balanced = gas.gauge_pressure(options.outside_pressure);
    }
    start.gas.push_back(gas);
    const double even = region.thickness > 0.0 ? region.thickness : material.thickness;
    start.even.push_back(region.fine.position.empty()
                             ? EvenFilm{even * region.area, film::start_surfactant(material) * region.area, region.held}
                             : EvenFilm{.held = region.held});
}

std::size_t particles_on(double area, double spacing) {
    constexpr double kFewest = 20.0;
    return static_cast<std::size_t>(std::max(std::round(area / (spacing * spacing)), kFewest));
}

/// Pairs of bubbles with a film between them that start from the mesh.
std::vector<RegionPair> joined_regions(const FoamMesh& mesh,
                                       const IdVector<RegionId, std::optional<Ball>>& loose,
                                       const std::vector<Gas>& gas) {
    IdVector<RegionId, std::int32_t> here(mesh.regions.size());
    for (std::size_t r = 0; r < gas.size(); ++r)
        here[static_cast<RegionId>(gas[r].region)] = static_cast<std::int32_t>(r);
    std::vector<RegionPair> joined;
    for (const mesh::Face& face : mesh.faces) {
        const auto closed = [&](RegionId r) { return mesh.regions[r].kind == RegionKind::kClosed && !loose[r]; };
        if (!closed(face.back) || !closed(face.front)) continue;
        const std::int32_t a = here[face.back], b = here[face.front];
        joined.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(joined.begin(), joined.end());
    joined.erase(std::unique(joined.begin(), joined.end()), joined.end());
    return joined;
}

/// A round bubble with a spacing h between its coarse particles.
RegionStart region_on(const Ball& ball, double h, int fine_ratio) {
    RegionStart region{.area = 4.0 * std::numbers::pi * ball.radius * ball.radius};
    region.volume = ball.radius * region.area / 3.0;
    region.coarse = on_ball(ball, particles_on(region.area, h));
    region.fine = on_ball(ball, static_cast<std::size_t>(fine_ratio) * region.coarse.position.size());
    return region;
}

}  // namespace

Rims start_rims(const film::Problem& films, const Options& options) {
    Rims rims;
    rims.set_wires(films.wires);
    auto region = static_cast<std::int32_t>(films.bubble_count() - static_cast<std::int64_t>(films.releases.size()));
    std::int32_t before = 0;
    for (const OpenFilm& film : open_films(films)) {
        for (std::size_t k = 0; k < film.rims.size(); ++k) {
            RimPiece piece = film.rims[k];
            piece.region = region;
            if (piece.corner_next >= 0) piece.corner_next += before;
            if (options.rim == RimHold::kWetPlate) piece.kind = RimKind::kPlate;
            rims.add(piece, film.wires[k][0], film.wires[k][1]);
        }
        before += static_cast<std::int32_t>(film.rims.size());
        ++region;
    }
    return rims;
}

Start start_particles(const film::Problem& films, const Options& options, std::uint64_t seed) {
    refuse_unknown_films(films, options);
    Start start;
    start.rims = start_rims(films, options);
    const std::vector<OpenFilm> open = open_films(films);
    const IdVector<RegionId, double> volume = mesh::region_volumes(films.mesh);
    const double h = films.edge_length;
    double total_area = 0.0, largest_radius = 0.0;
    for (const RegionId r : films.mesh.regions.ids())
        if (films.mesh.regions[r].kind == RegionKind::kClosed)
            largest_radius = std::max(largest_radius, std::cbrt(0.75 * volume[r] / std::numbers::pi));
    for (const OpenFilm& film : open)
        largest_radius = std::max(largest_radius, std::sqrt(film.area / std::numbers::pi));
    StartThickness thickness(films, options.start, seed, largest_radius);
    const IdVector<RegionId, std::optional<Ball>> loose = loose_balls(films.mesh);
    for (const RegionId r : films.mesh.regions.ids()) {
        if (films.mesh.regions[r].kind != RegionKind::kClosed || volume[r] == 0.0) continue;
        const RegionSurface surface = surface_of(films.mesh, r);
        const std::optional<Ball> ball = loose[r] ? loose[r] : ball_of(surface);
        RegionStart region;
        if (ball) {
            region = region_on(*ball, h, options.fine_ratio);
        } else {
            region.area = surface.area;
            region.volume = volume[r];
            region.coarse = {surface.vertex, surface.normal};
            region.fine = on_triangles(surface.triangle,
                                       static_cast<std::size_t>(options.fine_ratio) * region.coarse.position.size());
        }
        region.velocity = films.velocity[r];
        region.thickness = films.thickness[r];
        total_area += region.area;
        append(start, std::move(region), static_cast<std::int32_t>(index(r)), films.mesh.regions[r].target_volume,
               films.material, options, thickness);
    }
    start.joined = joined_regions(films.mesh, loose, start.gas);
    const std::vector<film::Body> bodies = film::bodies_at_start(films.solids);
    for (const OpenFilm& film : open) {
        RegionStart region{
            .area = film.area, .volume = options.rim == RimHold::kWire ? 0.0 : film.volume, .held = true};
        if (film.half_sphere()) region.center = film.rims[0].a;
        region.coarse = film.sample(particles_on(film.area, h));
        if (options.fine_ratio > 0)
            region.fine = film.sample(static_cast<std::size_t>(options.fine_ratio) * region.coarse.position.size());
        const auto whole = static_cast<double>(region.coarse.position.size() + region.fine.position.size());
        cut_out(bodies, region.coarse);
        cut_out(bodies, region.fine);
        if (region.coarse.position.empty()) throw InputError("melp: a [[solid]] covers all of a film");
        region.area *= static_cast<double>(region.coarse.position.size() + region.fine.position.size()) / whole;
        total_area += region.area;
        const double target = region.volume;
        append(start, std::move(region), film.back, target, films.material, options, thickness);
    }
    if (start.gas.empty() && films.releases.empty())
        throw InputError("melp: the scene has no film; add a [[bubble]] or a [[film]]");
    start.spacing = start.gas.empty() ? h : std::sqrt(total_area / static_cast<double>(start.coarse.size()));
    return start;
}

void append_release(Start& start,
                    const film::Problem& films,
                    const Options& options,
                    const film::Release& release,
                    std::uint64_t seed) {
    RegionStart region = region_on({release.center, release.radius}, films.edge_length, options.fine_ratio);
    region.velocity = release.velocity;
    StartThickness thickness(films, options.start, seed + index(release.region), release.radius);
    append(start, std::move(region), static_cast<std::int32_t>(index(release.region)),
           films.mesh.regions[release.region].target_volume, films.material, options, thickness);
}

}  // namespace lamella::melp
