#include "lamella/solvers/vortex_particle/surface.h"

#include "lamella/core/error.h"
#include "lamella/solvers/vortex_particle/leaves.h"
#include "lamella/solvers/vortex_particle/sheets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

/// Numbers the classes into which `join` has put vertices, in the order of their first members.
class Classes {
public:
    explicit Classes(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0U); }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a), b = root(b);
        parent_[std::max(a, b)] = std::min(a, b);  // so a root is the first member of its class
    }

private:
    std::vector<std::uint32_t> parent_;
};

void find_rings(Surface& s) {
    s.ring_start.assign(s.vertices() + 1, 0);
    for (const auto& corners : s.corner)
        for (const std::uint32_t v : corners) ++s.ring_start[v + 1];
    std::partial_sum(s.ring_start.begin(), s.ring_start.end(), s.ring_start.begin());
    s.ring.resize(s.ring_start.back());
    std::vector<std::size_t> next(s.ring_start.begin(), s.ring_start.end() - 1);
    for (std::uint32_t t = 0; t < s.triangles(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) s.ring[next[s.corner[t][k]]++] = {t, k};
}

void find_components_and_loops(Surface& s) {
    Classes parts(s.vertices()), walls(s.vertices());
    std::vector<double> wall_length(s.vertices(), 0.0);
    std::vector<std::uint8_t> on_wall(s.vertices(), 0);
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = s.corner[t][(k + 1) % 3], b = s.corner[t][(k + 2) % 3];
            parts.join(a, b);
            if (s.neighbor[t][k] != kNoNeighbor) continue;
            walls.join(a, b);
            on_wall[a] = on_wall[b] = 1;
            wall_length[a] += norm(s.edge(t, k));
        }
    s.component.resize(s.vertices());
    s.loop.assign(s.vertices(), -1);
    std::vector<std::size_t> members;
    for (std::uint32_t v = 0; v < s.vertices(); ++v) {
        const std::uint32_t part = parts.root(v);
        s.component[v] = part == v ? s.components++ : s.component[part];
        if (on_wall[v] == 0) continue;
        const std::uint32_t wall = walls.root(v);
        if (wall == v) {
            s.loop[v] = static_cast<std::int32_t>(s.loops.size());
            s.loops.push_back({.component = s.component[v], .center = {}});
            members.push_back(0);
        } else {
            s.loop[v] = s.loop[wall];
        }
        const auto l = static_cast<std::size_t>(s.loop[v]);
        s.loops[l].length += wall_length[v];
        s.loops[l].center += s.position[v];
        ++members[l];
    }
    std::vector<std::size_t> longest(s.components, s.loops.size());
    for (std::size_t l = 0; l < s.loops.size(); ++l) {
        s.loops[l].center *= 1.0 / static_cast<double>(members[l]);
        std::size_t& best = longest[s.loops[l].component];
        if (best == s.loops.size() || s.loops[l].length > s.loops[best].length) best = l;
    }
    for (const std::size_t l : longest)
        if (l < s.loops.size()) s.loops[l].outer = true;
}

/// @returns  a triangle without area, or their number
std::size_t measure(Surface& s) {
    s.total_area = s.longest_edge = 0.0;
    s.normal.resize(s.triangles());
    s.area.resize(s.triangles());
    s.hat_slope.resize(s.triangles());
    s.vertex_area.assign(s.vertices(), 0.0);
    s.vertex_share.assign(s.vertices(), 0.0);
    s.vertex_normal.assign(s.vertices(), {});
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const Vec3 twice = cross(s.edge(t, 2), s.edge(t, 0));
        const double length = norm(twice);
        if (!(length > 0.0)) return t;
        s.area[t] = 0.5 * length;
        s.normal[t] = twice / length;
        s.total_area += s.area[t];
        for (std::size_t k = 0; k < 3; ++k) {
            s.hat_slope[t][k] = cross(s.normal[t], s.edge(t, k)) / length;
            s.longest_edge = std::max(s.longest_edge, norm(s.edge(t, k)));
            s.vertex_area[s.corner[t][k]] += s.area[t] / 3.0;
            s.vertex_share[s.corner[t][k]] += s.share[t] * s.area[t] / 3.0;
            s.vertex_normal[s.corner[t][k]] += twice;
        }
    }
    for (Vec3& n : s.vertex_normal) n *= 1.0 / norm(n);
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        s.vertex_share[v] /= s.vertex_area[v];
        if (std::abs(s.vertex_share[v] - 1.0) < 1e-12)
            s.vertex_share[v] = 1.0;  // a sum of its own parts but for rounding
    }
    s.mean_edge = std::sqrt(4.0 / std::sqrt(3.0) * s.total_area / static_cast<double>(s.triangles()));
    return s.triangles();
}

/// The direction out of the film, along it, at the edge opposite to corner k.
Vec3 outward(const Surface& s, std::size_t t, std::size_t k) { return -s.hat_slope[t][k] / norm(s.hat_slope[t][k]); }

/// Ends of the film that the stream crosses; along all others it has to run.
void find_openings(Surface& s, const Vec3& stream) {
    constexpr double kCrosses = 0.5, kAlong = 1e-6;  // cosines
    const Vec3 ahead = stream / norm(stream);
    s.opening.assign(s.triangles(), {Opening::kNone, Opening::kNone, Opening::kNone});
    s.vertex_opening.assign(s.vertices(), Opening::kNone);
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        if (std::abs(dot(ahead, s.normal[t])) > kAlong)
            throw InputError("vortex_particle.stream.velocity does not lie in the film, which has to be flat");
        for (std::size_t k = 0; k < 3; ++k) {
            if (s.neighbor[t][k] != kNoNeighbor) continue;
            const double cosine = dot(ahead, outward(s, t, k));
            if (std::abs(cosine) < kAlong) continue;
            if (std::abs(cosine) < kCrosses)
                throw InputError(
                    "vortex_particle.stream.velocity runs into a wall of the film at a small angle; streams are "
                    "built for rectangles, along two of their sides");
            s.opening[t][k] = cosine > 0.0 ? Opening::kOutflow : Opening::kInflow;
            for (const std::uint32_t v : {s.corner[t][(k + 1) % 3], s.corner[t][(k + 2) % 3]})
                s.vertex_opening[v] = std::max(s.vertex_opening[v], s.opening[t][k]);
        }
    }
    for (std::size_t v = 0; v < s.vertices(); ++v)
        if (s.loop[v] >= 0 && !s.loops[static_cast<std::size_t>(s.loop[v])].outer)
            throw InputError(
                "vortex_particle.stream: the film has a hole, around which streams are not built; put a [[solid]] "
                "there");
}

void find_walls(Surface& s, Walls walls) {
    constexpr double kStraight = 0.9;  // cosine: walls that turn by more than 26 degrees make a corner
    s.place.assign(s.vertices(), Place::kInside);
    s.wall_normal.assign(s.vertices(), {});
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            if (s.neighbor[t][k] != kNoNeighbor || s.opening_of(t, k) != Opening::kNone || !s.meeting(t, k).empty())
                continue;
            const Vec3 out = outward(s, t, k);
            for (const std::uint32_t v : {s.corner[t][(k + 1) % 3], s.corner[t][(k + 2) % 3]}) {
                const bool first = s.place[v] == Place::kInside;
                const bool slips = walls == Walls::kSlip && (first || dot(s.wall_normal[v], out) > kStraight);
                s.place[v] = slips ? Place::kWall : Place::kStill;
                s.wall_normal[v] += out;
            }
        }
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        if (s.place[v] == Place::kWall)
            s.wall_normal[v] *= 1.0 / norm(s.wall_normal[v]);
        else
            s.wall_normal[v] = {};
    }
}

}  // namespace

Surface surface_of(const mesh::FoamMesh& mesh, Walls walls, const Vec3& stream, Junction junction) {
    if (mesh.periodic()) throw InputError("vortex_particle: films in a periodic box are for solver equilibrium");
    Surface s;
    junction == Junction::kSheets ? lay_sheets(mesh, s) : lay_leaves(mesh, s);
    find_rings(s);
    find_components_and_loops(s);
    const std::size_t flat = measure(s);
    if (flat != s.triangles())
        throw InputError(fmt::format("vortex_particle: triangle {} of the film has no area", flat));
    if (norm(stream) > 0.0) find_openings(s, stream);
    find_walls(s, walls);
    return s;
}

void place(const IdVector<mesh::VertexId, Vec3>& position, Walls walls, Surface& s) {
    for (std::size_t v = 0; v < s.vertices(); ++v) s.position[v] = position.values()[s.site[v]];
    const std::size_t flat = measure(s);
    if (flat != s.triangles())
        throw NumericalError(fmt::format("vortex_particle: triangle {} of the film has lost its area", flat));
    find_walls(s, walls);
}

void add_up_joints(const Surface& s, std::span<double> value) {
    if (!s.jointed()) return;
    for (std::size_t v = 0; v < value.size(); ++v)
        if (s.joint[v] != v) value[s.joint[v]] += value[v];
    for (std::size_t v = 0; v < value.size(); ++v) value[v] = value[s.joint[v]];
}

std::vector<std::uint32_t> connected_components(const Surface& s) {
    Classes parts(s.components);
    if (s.jointed())
        for (std::size_t v = 0; v < s.vertices(); ++v) parts.join(s.component[v], s.component[s.joint[v]]);
    std::vector<std::uint32_t> first(s.components);
    for (std::uint32_t c = 0; c < s.components; ++c) first[c] = parts.root(c);
    return first;
}

std::vector<double> whole_thickness(const Surface& s, std::span<const double> leaves) {
    std::vector<double> whole(leaves.begin(), leaves.end());
    for (std::size_t v = 0; v < whole.size(); ++v) whole[v] /= s.vertex_share[v];
    return whole;
}

Vec3 turned(const Vec3& u, const Vec3& from, const Vec3& to) {
    // Rodrigues' formula about from x to; for a tangent vector u of the first plane, from . u = 0.
    const double cosine = dot(from, to);
    if (cosine >= 1.0 - 1e-15) return u;
    return u - (dot(u, to) / (1.0 + cosine)) * (from + to);
}

}  // namespace lamella::vortex_particle
