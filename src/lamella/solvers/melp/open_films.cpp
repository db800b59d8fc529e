#include "lamella/solvers/melp/open_films.h"

#include "lamella/core/error.h"
#include "lamella/solvers/melp/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace lamella::melp {
namespace {

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;
using mesh::VertexId;

constexpr double kSame = 1e-6;  // relative

using Loop = std::vector<VertexId>;

/// Chains edges, each from the vertex to the one that follows it, into closed loops.
std::vector<Loop> loops_of(std::map<VertexId, VertexId> next) {
    std::vector<Loop> loops;
    while (!next.empty()) {
        Loop loop{next.begin()->first};
        for (;;) {
            const auto step = next.find(loop.back());
            if (step == next.end()) throw InputError("melp: a film of this scene has a rim that is no closed curve");
            const VertexId to = step->second;
            next.erase(step);
            if (to == loop.front()) break;
            loop.push_back(to);
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

/// The circle through all vertices and around them, if there is one.
std::optional<RimPiece> ring_of(const FoamMesh& mesh, const Loop& loop) {
    constexpr std::size_t kFewest = 12;  // fewer make a polygon
    if (loop.size() < kFewest) return std::nullopt;
    RimPiece ring{.kind = RimKind::kRing};
    for (const VertexId v : loop) ring.a += mesh.position[v] / static_cast<double>(loop.size());
    for (std::size_t k = 0; k < loop.size(); ++k)
        ring.b += cross(mesh.position[loop[k]] - ring.a, mesh.position[loop[(k + 1) % loop.size()]] - ring.a);
    if (!(norm(ring.b) > 0.0)) return std::nullopt;
    ring.b = ring.b / norm(ring.b);
    ring.radius = norm(mesh.position[loop[0]] - ring.a);
    for (const VertexId v : loop) {
        const Vec3 arm = mesh.position[v] - ring.a;
        if (std::abs(norm(arm) - ring.radius) > kSame * ring.radius || std::abs(dot(arm, ring.b)) > kSame * ring.radius)
            return std::nullopt;
    }
    return ring;
}

/// The vertices of a loop where its direction changes.
Loop corners_of(const FoamMesh& mesh, const Loop& loop) {
    Loop corners;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3& x = mesh.position[loop[k]];
        const Vec3 in = x - mesh.position[loop[(k + loop.size() - 1) % loop.size()]];
        const Vec3 out = mesh.position[loop[(k + 1) % loop.size()]] - x;
        if (norm(cross(in, out)) > kSame * norm(in) * norm(out)) corners.push_back(loop[k]);
    }
    return corners;
}

void append_polygon(const film::Problem& films,
                    const Loop& loop,
                    const IdVector<VertexId, Vec3>& normal,
                    OpenFilm& film) {
    const FoamMesh& mesh = films.mesh;
    const Loop corners = corners_of(mesh, loop);
    const auto first = static_cast<std::int32_t>(film.rims.size()), count = static_cast<std::int32_t>(corners.size());
    for (std::int32_t k = 0; k < count; ++k) {
        const VertexId v = corners[static_cast<std::size_t>(k)], w = corners[static_cast<std::size_t>((k + 1) % count)];
        const VertexId u = corners[static_cast<std::size_t>((k + count - 1) % count)];
        const Vec3 in = mesh.position[v] - mesh.position[u], out = mesh.position[w] - mesh.position[v];
        if (dot(cross(in, out), normal[v]) < -kSame * norm(in) * norm(out))
            throw InputError("melp: rims with corners that point into the film are not built yet");
        film.rims.push_back({.kind = RimKind::kLine,
                             .a = mesh.position[v],
                             .b = mesh.position[w],
                             .corner_next = first + (k + 1) % count});
        film.wires.push_back({films.wire_of[v], films.wire_of[w]});
    }
}

}  // namespace

std::vector<OpenFilm> open_films(const film::Problem& films) {
    const FoamMesh& mesh = films.mesh;
    std::map<std::array<RegionId, 2>, OpenFilm> found;
    std::map<std::array<VertexId, 2>, int> faces_at;
    std::map<std::array<RegionId, 2>, std::map<VertexId, VertexId>> edges;
    IdVector<VertexId, Vec3> normal(mesh.position.size());
    for (const mesh::FaceId f : mesh.faces.ids()) {
        const mesh::Face& face = mesh.faces[f];
        if (mesh.regions[face.back].kind != RegionKind::kOpen || mesh.regions[face.front].kind != RegionKind::kOpen)
            continue;
        OpenFilm& film = found[{face.back, face.front}];
        film.back = static_cast<std::int32_t>(index(face.back));
        const std::array<Vec3, 3> corner{mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2)};
        film.triangle_.push_back(corner);
        const Vec3 area = 0.5 * cross(corner[1] - corner[0], corner[2] - corner[0]);
        film.area += norm(area);
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = face.vertices[k], b = face.vertices[(k + 1) % 3];
            normal[a] += area;
            if (++faces_at[{std::min(a, b), std::max(a, b)}] > 2)
                throw InputError(
                    "melp: films on wires that meet along a border are not built yet; use solver "
                    "equilibrium or vortex_sheet");
        }
    }
    for (const mesh::FaceId f : mesh.faces.ids()) {
        const mesh::Face& face = mesh.faces[f];
        if (!found.contains({face.back, face.front})) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = face.vertices[k], b = face.vertices[(k + 1) % 3];
            if (faces_at[{std::min(a, b), std::max(a, b)}] != 1) continue;
            if (mesh.on_wire[a] == 0 || mesh.on_wire[b] == 0)
                throw InputError("melp: a film of this scene ends in the air, with no wire along its edge");
            edges[{face.back, face.front}][a] = b;
        }
    }
    std::vector<OpenFilm> result;
    for (auto& [pair, film] : found) {
        for (const Loop& loop : loops_of(edges[pair])) {
            if (const std::optional<RimPiece> ring = ring_of(mesh, loop)) {
                film.rims.push_back(*ring);
                film.wires.push_back({films.wire_of[loop[0]], films.wire_of[loop[0]]});
            } else {
                append_polygon(films, loop, normal, film);
            }
        }
        film.recognize();
        result.push_back(std::move(film));
    }
    return result;
}

/// Shapes whose particles lie on curves that are more even than a mesh is.
void OpenFilm::recognize() {
    if (rims.size() == 1 && rims[0].kind == RimKind::kRing) {
        const RimPiece& ring = rims[0];
        bool flat = true, round = true;
        for (const auto& t : triangle_)
            for (const Vec3& x : t) {
                flat = flat && std::abs(dot(x - ring.a, ring.b)) < kSame * ring.radius;
                round = round && std::abs(norm(x - ring.a) - ring.radius) < kSame * ring.radius;
            }
        shape_ = flat ? Shape::kDisk : round ? Shape::kHalfSphere : Shape::kMesh;
        const double disk = std::numbers::pi * ring.radius * ring.radius;
        if (flat) area = disk;
        if (shape_ == Shape::kHalfSphere) {
            area = 2.0 * disk;
            volume = 2.0 / 3.0 * disk * ring.radius;
        }
    } else if (rims.size() == 4 && rims[0].kind == RimKind::kLine) {
        const Vec3 u = rims[0].b - rims[0].a, v = rims[1].b - rims[1].a;
        const bool square = std::abs(dot(u, v)) < kSame * norm(u) * norm(v);
        const bool closed = norm(rims[2].b - rims[2].a + u) < kSame * norm(u);
        if (square && closed && std::abs(norm(cross(u, v)) - area) < kSame * area) shape_ = Shape::kRectangle;
    }
}

namespace {

constexpr double kGoldenAngle = 2.399963229728653;  // pi (3 - sqrt 5)

/// Vogel's spiral: point i at the radius that leaves i + 1/2 shares of the area inside.
Sample on_disk(const RimPiece& ring, std::size_t count) {
    const Frame frame = frame_of(ring.b);
    Sample sample;
    for (std::size_t i = 0; i < count; ++i) {
        const double r = ring.radius * std::sqrt((static_cast<double>(i) + 0.5) / static_cast<double>(count));
        const double angle = kGoldenAngle * static_cast<double>(i);
        sample.position.push_back(ring.a + (r * std::cos(angle)) * frame.e1 + (r * std::sin(angle)) * frame.e2);
        sample.normal.push_back(ring.b);
    }
    return sample;
}

/// The same on the half of a sphere that `top` points to: equal shares of height have equal areas.
Sample on_half_sphere(const RimPiece& ring, const Vec3& top, std::size_t count) {
    const Frame frame = frame_of(top);
    Sample sample;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1.0 - (static_cast<double>(i) + 0.5) / static_cast<double>(count), r = std::sqrt(1.0 - z * z);
        const double angle = kGoldenAngle * static_cast<double>(i);
        const Vec3 n = (r * std::cos(angle)) * frame.e1 + (r * std::sin(angle)) * frame.e2 + z * top;
        sample.position.push_back(ring.a + ring.radius * n);
        sample.normal.push_back(n);
    }
    return sample;
}

/// Rows along u, moved by a quarter of their spacing to the right and to the left in turn.
Sample on_rectangle(const Vec3& corner, const Vec3& u, const Vec3& v, std::size_t count) {
    const double h = std::sqrt(norm(cross(u, v)) / static_cast<double>(std::max(count, std::size_t{1})));
    const double row = h * std::sqrt(std::sqrt(0.75));  // equal triangles of area h^2 / 2
    const auto rows = static_cast<std::size_t>(std::max(std::round(norm(v) / row), 1.0));
    const auto columns =
        static_cast<std::size_t>(std::max(std::round(static_cast<double>(count) / static_cast<double>(rows)), 1.0));
    const Vec3 normal = cross(u, v) / norm(cross(u, v));
    Sample sample;
    for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i) {
            const double s = (static_cast<double>(i) + (j % 2 == 0 ? 0.25 : 0.75)) / static_cast<double>(columns);
            const double t = (static_cast<double>(j) + 0.5) / static_cast<double>(rows);
            sample.position.push_back(corner + s * u + t * v);
            sample.normal.push_back(normal);
        }
    return sample;
}

}  // namespace

Sample on_triangles(const std::vector<std::array<Vec3, 3>>& triangles, std::size_t count) {
    double total = 0.0;
    for (const auto& t : triangles) total += 0.5 * norm(cross(t[1] - t[0], t[2] - t[0]));
    Sample sample;
    double owed = 0.0;
    std::uint64_t drawn = 0;
    for (const auto& t : triangles) {
        const Vec3 area = 0.5 * cross(t[1] - t[0], t[2] - t[0]);
        owed += static_cast<double>(count) * norm(area) / total;
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

Sample OpenFilm::sample(std::size_t count) const {
    switch (shape_) {
        case Shape::kDisk:
            return on_disk(rims[0], count);
        case Shape::kHalfSphere: {
            const auto& t = triangle_[0];
            const double side = dot((t[0] + t[1] + t[2]) / 3.0 - rims[0].a, rims[0].b);
            return on_half_sphere(rims[0], side < 0.0 ? -rims[0].b : rims[0].b, count);
        }
        case Shape::kRectangle:
            return on_rectangle(rims[0].a, rims[0].b - rims[0].a, rims[1].b - rims[1].a, count);
        case Shape::kMesh:
            break;
    }
    return on_triangles(triangle_, count);
}

}  // namespace lamella::melp
