#include "lamella/solvers/melp/start.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/film/noise.h"
#include "lamella/film/surfactant.h"
#include "lamella/mesh/volume.h"
#include "lamella/solvers/melp/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace lamella::melp {
namespace {

using mesh::FaceId;
using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;
using mesh::VertexId;

/// Where bubbles meet, films fold within a few spacings: folds have to fit onto the bubble.
void refuse_coarse_contacts(const film::Problem& films) {
    const auto& regions = films.mesh.regions;
    const auto bubbles =
        std::count_if(regions.begin(), regions.end(), [](const auto& r) { return r.kind == RegionKind::kClosed; });
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

/// Points on a surface, with its normals.
struct Sample {
    std::vector<Vec3> position, normal;
};

Sample on_ball(const Ball& ball, std::size_t count) {
    Sample sample{{}, fibonacci_sphere(count)};
    for (const Vec3& n : sample.normal) sample.position.push_back(ball.center + ball.radius * n);
    return sample;
}

/// Points on triangles, as many on each as its area asks for, along a sequence that fills each evenly.
Sample on_triangles(const RegionSurface& surface, std::size_t count) {
    Sample sample;
    double owed = 0.0;
    std::uint64_t drawn = 0;
    for (const auto& t : surface.triangle) {
        const Vec3 area = 0.5 * cross(t[1] - t[0], t[2] - t[0]);
        owed += static_cast<double>(count) * norm(area) / surface.area;
        for (; owed >= 0.5; owed -= 1.0, ++drawn) {
            // Roberts' sequence: multiples of the powers of 1 / 1.3247..., the root of x^3 = x + 1, modulo one.
            constexpr double kStep1 = 0.7548776662466927, kStep2 = 0.5698402909980532;
            const auto d = static_cast<double>(drawn);
            double a = d * kStep1 - std::floor(d * kStep1), b = d * kStep2 - std::floor(d * kStep2);
            if (a + b > 1.0) {
                a = 1.0 - a;
                b = 1.0 - b;
            }
            sample.position.push_back(t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]));
            sample.normal.push_back(area / norm(area));
        }
    }
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
    for (const mesh::Face& face : mesh.faces)
        for (const RegionId r : {face.back, face.front})
            if (r != mesh::kOutside && mesh.regions[r].kind != RegionKind::kClosed)
                throw InputError("melp: films on wires are not built yet; it knows closed bubbles ([[bubble]])");
    for (const VertexId v : mesh.position.ids())
        if (mesh.on_wire[v] != 0) throw InputError("melp: films on wires are not built yet; use solver vortex_sheet");
    if (!films.wires.empty()) throw InputError("melp: [[wire]] is not built yet; use solver vortex_sheet");
    if (!films.tensions.empty()) throw InputError("melp: [[tension]] is not built yet; use solver equilibrium");
    if (!films.events.empty())
        throw InputError("melp: [[event]] is not built yet; use solver vortex_sheet or equilibrium");
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

Start start_particles(const film::Problem& films, const Options& options, std::uint64_t seed) {
    refuse_unknown_films(films, options);
    Start start;
    const IdVector<RegionId, double> volume = mesh::region_volumes(films.mesh);
    const double h = films.edge_length;
    const double surfactant = film::start_surfactant(films.material);
    double total_area = 0.0, largest_radius = 0.0;
    for (const RegionId r : films.mesh.regions.ids())
        if (films.mesh.regions[r].kind == RegionKind::kClosed)
            largest_radius = std::max(largest_radius, std::cbrt(0.75 * volume[r] / std::numbers::pi));
    const double wave_length = options.start.noise_length > 0.0 ? options.start.noise_length : 1.4 * largest_radius;
    const auto noise = [&](const Vec3& x) {
        return options.start.thickness_noise * film::gradient_noise(x / wave_length, seed, options.start.noise_octaves);
    };
    for (const RegionId r : films.mesh.regions.ids()) {
        if (films.mesh.regions[r].kind != RegionKind::kClosed) continue;
        const RegionSurface surface = surface_of(films.mesh, r);
        const std::optional<Ball> ball = ball_of(surface);
        const double area = ball ? 4.0 * std::numbers::pi * ball->radius * ball->radius : surface.area;
        const double v = ball ? ball->radius * area / 3.0 : volume[r];
        const auto region = static_cast<std::int32_t>(start.gas.size());
        const auto coarse_count = static_cast<std::size_t>(std::max(std::round(area / (h * h)), 20.0));
        Sample coarse = ball ? on_ball(*ball, coarse_count) : Sample{surface.vertex, surface.normal};
        const std::size_t fine_count = static_cast<std::size_t>(options.fine_ratio) * coarse.position.size();
        Sample fine = ball ? on_ball(*ball, fine_count) : on_triangles(surface, fine_count);
        Vec3 center;
        for (const Vec3& x : coarse.position) center += x / static_cast<double>(coarse.position.size());
        const double share = area / static_cast<double>(std::max(fine.position.size(), std::size_t{1}));
        for (const Vec3& x : fine.position) {
            const double thick = std::max(1.0 + noise((x - center)), 0.05);
            start.fine.liquid_volume.push_back(thick * films.material.thickness * share);
            start.fine.surfactant.push_back(thick * surfactant * share);
            start.fine.thickness.push_back(thick * films.material.thickness);
        }
        deform(coarse.position, center, options.start);
        deform(fine.position, center, options.start);

        const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        append(start.coarse.position, coarse.position);
        append(start.coarse.frame_normal, coarse.normal);
        start.coarse.velocity.resize(start.coarse.position.size(), films.velocity[r]);
        start.coarse.region.resize(start.coarse.position.size(), region);
        append(start.fine.position, fine.position);
        append(start.fine.normal, fine.normal);
        start.fine.velocity.resize(start.fine.position.size(), films.velocity[r]);
        start.fine.gradient.resize(start.fine.position.size());
        start.fine.region.resize(start.fine.position.size(), region);

        const double pressure = options.outside_pressure + 2.0 / 3.0 * films.material.film_tension() * area / v;
        start.gas.push_back({.region = static_cast<std::int32_t>(index(r)),
                             .amount = pressure * films.mesh.regions[r].target_volume,
                             .volume = v});
        start.even.push_back(fine.position.empty() ? EvenFilm{films.material.thickness * area, surfactant * area}
                                                   : EvenFilm{});
        total_area += area;
    }
    if (start.gas.empty()) throw InputError("melp: the scene has no bubble; add a [[bubble]]");
    start.spacing = std::sqrt(total_area / static_cast<double>(start.coarse.size()));
    return start;
}

std::vector<double> particle_volumes(const CoarseParticles& coarse,
                                     const Geometry& geometry,
                                     const std::vector<Gas>& gas) {
    std::vector<Vec3> center(gas.size());
    std::vector<double> area(gas.size(), 0.0), volume(gas.size(), 0.0);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const auto r = static_cast<std::size_t>(coarse.region[i]);
        center[r] += geometry.area[i] * coarse.position[i];
        area[r] += geometry.area[i];
    }
    for (std::size_t r = 0; r < gas.size(); ++r) center[r] = center[r] / area[r];
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
