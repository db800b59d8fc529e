#include "lamella/solvers/melp/start.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/film/noise.h"
#include "lamella/film/surfactant.h"
#include "lamella/mesh/volume.h"
#include "lamella/solvers/melp/open_films.h"
#include "lamella/solvers/melp/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace lamella::melp {
namespace {

using mesh::FaceId;
using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;
using mesh::VertexId;

std::int64_t bubble_count(const film::Problem& films) {
    const auto& regions = films.mesh.regions;
    return std::count_if(regions.begin(), regions.end(), [](const auto& r) { return r.kind == RegionKind::kClosed; });
}

/// Where bubbles meet, films fold within a few spacings: folds have to fit onto the bubble.
void refuse_coarse_contacts(const film::Problem& films) {
    const auto& regions = films.mesh.regions;
    const auto bubbles = bubble_count(films);
    if (bubbles < 2) return;
    constexpr double kFinest = 6.0;
    for (const RegionId r : regions.ids()) {
        const double radius = std::cbrt(0.75 * regions[r].target_volume / std::numbers::pi);
        if (regions[r].kind == RegionKind::kClosed && films.edge_length > 1.001 * radius / kFinest)
            throw InputError(
                fmt::format("resolution.edge_length = {:.4g} m is too coarse for bubble {} among others: at most a "
                            "sixth of its radius of {:.4g} m will do",
                            films.edge_length, index(r), radius));
    }
}

/// Balls that overlap at the start are meshed as cells of up to twice their volume: gas would burst out of them.
void refuse_wrong_volumes(const film::Problem& films) {
    constexpr double kFarthest = 0.1;
    const IdVector<RegionId, double> volume = mesh::region_volumes(films.mesh);
    for (const RegionId r : films.mesh.regions.ids()) {
        const mesh::Region& region = films.mesh.regions[r];
        if (region.kind == RegionKind::kClosed && std::abs(volume[r] / region.target_volume - 1.0) > kFarthest)
            throw InputError(
                fmt::format("melp: bubble {} would start with {:.3g} times its volume, as bubbles that overlap at the "
                            "start do; put them a hundredth of a radius apart, they join by themselves",
                            index(r), volume[r] / region.target_volume));
    }
}

/// The surface of one closed region.
struct RegionSurface {
    std::vector<std::array<Vec3, 3>> triangle;  ///< seen from outside in mathematical order
    std::vector<Vec3> vertex, normal;           ///< its vertices, and the area vectors around them
    double area = 0.0;
};

RegionSurface surface_of(const FoamMesh& mesh, RegionId region) {
    RegionSurface surface;
    IdVector<VertexId, Vec3> around(mesh.position.size());
    for (const FaceId f : mesh.faces.ids()) {
        const mesh::Face& face = mesh.faces[f];
        if (face.back != region && face.front != region) continue;
        std::array<Vec3, 3> corner{mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)};
        if (face.front == region) std::swap(corner[1], corner[2]);
        const Vec3 area = 0.5 * cross(corner[1] - corner[0], corner[2] - corner[0]);
        for (const VertexId v : face.vertices) around[v] += area;
        surface.area += norm(area);
        surface.triangle.push_back(corner);
    }
    for (const VertexId v : around.ids())
        if (squared_norm(around[v]) > 0.0) {
            surface.vertex.push_back(mesh.position[v]);
            surface.normal.push_back(around[v] / norm(around[v]));
        }
    return surface;
}

struct Ball {
    Vec3 center;
    double radius = 0.0;
};

/// The ball whose surface this is, if all vertices are at one distance from their mean.
std::optional<Ball> ball_of(const RegionSurface& surface) {
    Ball ball;
    for (const Vec3& x : surface.vertex) ball.center += x / static_cast<double>(surface.vertex.size());
    for (const Vec3& x : surface.vertex)
        ball.radius += norm(x - ball.center) / static_cast<double>(surface.vertex.size());
    constexpr double kRound = 1e-6;
    for (const Vec3& x : surface.vertex)
        if (std::abs(norm(x - ball.center) - ball.radius) > kRound * ball.radius) return std::nullopt;
    return ball;
}

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

/// What lies at particle i between its film and those of other bubbles that it has pushed through [m^3]: the gases
/// press films of a partition a few tenths of a spacing into each other until cohesion holds them. Negative where they
/// gape.
double overlap_volume(const CoarseParticles& coarse, const Geometry& geometry, std::size_t i) {
    const Neighbors& other = geometry.neighbors.other;
    double depth = 0.0;
    for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
        const std::size_t j = other.index[k];
        depth += 0.5 * geometry.area[j] * other.weight[k] *
                 dot(coarse.position[i] - coarse.position[j], geometry.normal[i] - geometry.normal[j]);
    }
    return geometry.area[i] * depth;
}

}  // namespace

void refuse_unknown_films(const film::Problem& films, const Options& options) {
    const FoamMesh& mesh = films.mesh;
    if (mesh.periodic()) throw InputError("melp: films in a periodic box are for solver equilibrium");
    const auto kind = [&](RegionId r) { return mesh.regions[r].kind; };
    IdVector<VertexId, std::uint8_t> of_bubble(mesh.position.size());
    for (const mesh::Face& face : mesh.faces) {
        const bool back = kind(face.back) == RegionKind::kClosed, front = kind(face.front) == RegionKind::kClosed;
        if (back || front)
            for (const VertexId v : face.vertices) of_bubble[v] = 1;
        if ((back && !front && face.front != mesh::kOutside) || (front && !back && face.back != mesh::kOutside))
            throw InputError("melp: bubbles in films on wires are not built yet; use solver vortex_sheet");
    }
    for (const VertexId v : mesh.position.ids())
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
    if (!films.tensions.empty()) throw InputError("melp: [[tension]] is not built yet; use solver equilibrium");
    if (!films.solids.empty()) throw InputError("melp: [[solid]] is not built yet; use solver vortex_particle");
    if (!films.vortices.empty()) throw InputError("melp: [[vortex]] is not built yet; use solver vortex_particle");
    for (const film::Event& event : films.events) {
        if (event.kind == film::Event::Kind::kInflate)
            throw InputError("melp: [[event]] with kind = \"inflate\" is not built yet; use solver vortex_sheet");
        if (event.region == film::kRandomBubble || event.into != film::kLargestNeighbor)
            throw InputError("melp: [[event]] pop takes a region and no `into`: the bubble bursts into the air");
        if (options.fine_ratio == 0)
            throw InputError(
                "melp.fine_ratio = 0: films burst only with fine particles, whose liquid the edge gathers");
        if (bubble_count(films) > 1) throw InputError("melp: [[event]] in scenes of several bubbles is not built yet");
    }
    refuse_coarse_contacts(films);
    refuse_wrong_volumes(films);
}

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
    Vec3 velocity{};
    std::optional<Vec3> center{};  ///< of modes and noise; nothing: the mean of its particles
    bool held = false;
};

/// Liquid of a film at the start, per material.thickness.
class StartThickness {
public:
    StartThickness(const film::Problem& films, const StartOptions& options, std::uint64_t seed, double largest_radius)
        : options_(options),
          wave_length_(options.noise_length > 0.0 ? options.noise_length : 1.4 * largest_radius),
          seed_(seed),
          thickness_(films.material.thickness),
          up_(norm(films.material.gravity) > 0.0 ? -films.material.gravity : Vec3{{0.0, 0.0, 1.0}}) {
        up_ = up_ / norm(up_);
    }

    /// Sets the range of heights of a film.
    void begin(const std::vector<Vec3>& position) {
        low_ = std::numeric_limits<double>::infinity();
        high_ = -low_;
        for (const Vec3& x : position) {
            low_ = std::min(low_, dot(up_, x));
            high_ = std::max(high_, dot(up_, x));
        }
    }
    /// @param arm  from the film's center
    double at(const Vec3& x, const Vec3& arm) const {
        const double top = options_.thickness_top > 0.0 ? options_.thickness_top / thickness_ : 1.0;
        const double bottom = options_.thickness_bottom > 0.0 ? options_.thickness_bottom / thickness_ : 1.0;
        const double height = high_ > low_ ? (dot(up_, x) - low_) / (high_ - low_) : 0.5;
        const double noise =
            options_.thickness_noise * film::gradient_noise(arm / wave_length_, seed_, options_.noise_octaves);
        constexpr double kThinnest = 0.05;
        return std::max((bottom + height * (top - bottom)) * (1.0 + noise), kThinnest);
    }

private:
    const StartOptions& options_;
    double wave_length_;
    std::uint64_t seed_;
    double thickness_;
    Vec3 up_;
    double low_ = 0.0, high_ = 0.0;
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
    thickness.begin(region.fine.position);
    for (const Vec3& x : region.fine.position) {
        const double thick = thickness.at(x, x - center);
        const double soap = options.start.surfactant == StartSurfactant::kUniform ? 1.0 : thick;
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
    start.fine.region.resize(start.fine.position.size(), here);

    Gas gas{.region = number,
            .volume = region.volume,
            .closed = region.volume > 0.0,
            .held = region.held,
            .film_radius = std::sqrt(region.area / std::numbers::pi)};
    if (gas.closed) {
        const double gauge = 2.0 / 3.0 * material.film_tension() * region.area / region.volume;
        gas.amount = (options.outside_pressure + gauge) * target_volume;
    }
    start.gas.push_back(gas);
    start.even.push_back(
        region.fine.position.empty()
            ? EvenFilm{material.thickness * region.area, film::start_surfactant(material) * region.area, region.held}
            : EvenFilm{.held = region.held});
}

std::size_t particles_on(double area, double spacing) {
    constexpr double kFewest = 20.0;
    return static_cast<std::size_t>(std::max(std::round(area / (spacing * spacing)), kFewest));
}

}  // namespace

Rims start_rims(const film::Problem& films, const Options& options) {
    Rims rims;
    rims.set_wires(films.wires);
    auto region = static_cast<std::int32_t>(bubble_count(films));
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
    for (const RegionId r : films.mesh.regions.ids()) {
        if (films.mesh.regions[r].kind != RegionKind::kClosed) continue;
        const RegionSurface surface = surface_of(films.mesh, r);
        const std::optional<Ball> ball = ball_of(surface);
        RegionStart region{.area = ball ? 4.0 * std::numbers::pi * ball->radius * ball->radius : surface.area,
                           .velocity = films.velocity[r]};
        region.volume = ball ? ball->radius * region.area / 3.0 : volume[r];
        region.coarse = ball ? on_ball(*ball, particles_on(region.area, h)) : Sample{surface.vertex, surface.normal};
        const std::size_t fine = static_cast<std::size_t>(options.fine_ratio) * region.coarse.position.size();
        region.fine = ball ? on_ball(*ball, fine) : on_triangles(surface.triangle, fine);
        total_area += region.area;
        append(start, std::move(region), static_cast<std::int32_t>(index(r)), films.mesh.regions[r].target_volume,
               films.material, options, thickness);
    }
    for (const OpenFilm& film : open) {
        RegionStart region{
            .area = film.area, .volume = options.rim == RimHold::kWire ? 0.0 : film.volume, .held = true};
        if (film.half_sphere()) region.center = film.rims[0].a;
        region.coarse = film.sample(particles_on(film.area, h));
        if (options.fine_ratio > 0)
            region.fine = film.sample(static_cast<std::size_t>(options.fine_ratio) * region.coarse.position.size());
        total_area += region.area;
        const double target = region.volume;
        append(start, std::move(region), film.back, target, films.material, options, thickness);
    }
    if (start.gas.empty()) throw InputError("melp: the scene has no film; add a [[bubble]] or a [[film]]");
    start.spacing = std::sqrt(total_area / static_cast<double>(start.coarse.size()));
    return start;
}

std::vector<double> particle_volumes(const CoarseParticles& coarse,
                                     const Geometry& geometry,
                                     std::span<const RimPiece> rims,
                                     const std::vector<Gas>& gas) {
    std::vector<Vec3> center(gas.size());
    std::vector<double> area(gas.size(), 0.0), volume(gas.size(), 0.0);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const auto r = static_cast<std::size_t>(coarse.region[i]);
        center[r] += geometry.area[i] * coarse.position[i];
        area[r] += geometry.area[i];
    }
    for (std::size_t r = 0; r < gas.size(); ++r) center[r] = center[r] / area[r];
    for (const RimPiece& piece : rims) center[static_cast<std::size_t>(piece.region)] = piece.a;  // in the plate
    std::vector<double> share(coarse.size());
    parallel_for(coarse.size(), [&](std::size_t i) {
        const Vec3& o = center[static_cast<std::size_t>(coarse.region[i])];
        const Neighbors& other = geometry.neighbors.other;
        share[i] = other.begin(i) == other.end(i)
                       ? geometry.area[i] * dot(coarse.position[i] - o, geometry.normal[i]) / 3.0
                       : star_volume(coarse, geometry, i, o) - 0.5 * overlap_volume(coarse, geometry, i);
    });
    for (std::size_t i = 0; i < coarse.size(); ++i) volume[static_cast<std::size_t>(coarse.region[i])] += share[i];
    for (std::size_t r = 0; r < gas.size(); ++r) volume[r] *= gas[r].calibration;
    return volume;
}

}  // namespace lamella::melp
